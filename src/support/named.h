/* Tables of rows that have a name. */
#ifndef DEA_SUPPORT_NAMED_H
#define DEA_SUPPORT_NAMED_H

#include <stddef.h>
#include <string.h>

/* TYPE_count(), how many rows there are; TYPE_at(), NULL past the end; TYPE_find(), NULL where none has the name. @p row: that of
 * `index`. */
#define DEA_NAMED_ROWS(type, rows, row)                                                                                          \
    size_t type##_count(void)                                                                                                    \
    {                                                                                                                            \
        return sizeof rows / sizeof *rows;                                                                                       \
    }                                                                                                                            \
    const type *type##_at(size_t index)                                                                                          \
    {                                                                                                                            \
        return index < type##_count() ? row : NULL;                                                                              \
    }                                                                                                                            \
    const type *type##_find(const char *name)                                                                                    \
    {                                                                                                                            \
        for (size_t index = 0; name && index < type##_count(); index++) {                                                        \
            if (strcmp((row)->name, name) == 0) {                                                                                \
                return row;                                                                                                      \
            }                                                                                                                    \
        }                                                                                                                        \
        return NULL;                                                                                                             \
    }

#endif
