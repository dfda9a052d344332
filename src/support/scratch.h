/* Temporary files. */
#ifndef DEA_SUPPORT_SCRATCH_H
#define DEA_SUPPORT_SCRATCH_H

#include <stdio.h>

/* The folder for them: $TMPDIR where that is an absolute path of a folder that can be written, else /tmp. */
const char *dea_scratch_folder(void);
/* A file without a name that children do not inherit; NULL with errno. The caller closes it. */
FILE *dea_scratch_open(void);

#endif
