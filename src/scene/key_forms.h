/* Forms of the rows of a table of keys: scalars, scalars of a mapping that a scene may have, of a list, and all else. */
#ifndef DEA_SCENE_KEY_FORMS_H
#define DEA_SCENE_KEY_FORMS_H

#include <math.h>

#include "scene/reader.h"

#define AT(member) offsetof(dea_scene, member)
#define SCALAR(name, member, si, ending, from, to, ends, has, shown, help)                                                       \
    {                                                                                                                            \
        .path = name, .read = dea_read_scalar, .offset = AT(member), .unit = si, .suffix = ending, .low = from, .high = to,      \
        .open = ends, .kinds = has, .words = shown, .accepted = help                                                             \
    }
#define PART(name, member, si, ending, from, to, ends, shown, mapping, help)                                                     \
    {                                                                                                                            \
        .path = name, .read = dea_read_scalar, .offset = AT(member), .unit = si, .suffix = ending, .low = from, .high = to,      \
        .open = ends, .kinds = DEA_KEY_BOTH, .words = shown, .within = mapping, .accepted = help                                 \
    }
#define ENTRY(name, list, member, si, ending, from, to, ends, shown, help)                                                       \
    {                                                                                                                            \
        .path = name, .read = dea_read_scalar, .offset = AT(list[0].member), .stride = sizeof(((dea_scene *)0)->list[0]),        \
        .unit = si, .suffix = ending, .low = from, .high = to, .open = ends, .kinds = DEA_KEY_BOTH, .words = shown,              \
        .accepted = help                                                                                                         \
    }
#define OTHER(name, reader, help)                                                                                                \
    {                                                                                                                            \
        .path = name, .read = reader, .offset = DEA_KEY_NOWHERE, .kinds = DEA_KEY_BOTH, .accepted = help                         \
    }

/* A count from @p least to @p most. */
#define AMOUNT(name, member, least, most, mapping, help)                                                                         \
    {                                                                                                                            \
        .path = name, .read = dea_read_count, .offset = DEA_KEY_NOWHERE, .place = AT(member), .low = least, .high = most,        \
        .kinds = DEA_KEY_BOTH, .within = mapping, .accepted = help                                                               \
    }

/* One of two words, of which the second sets a bool. */
#define CHOICE(name, member, plain, set)                                                                                         \
    {                                                                                                                            \
        .path = name, .read = dea_read_choice, .offset = DEA_KEY_NOWHERE, .place = AT(member),                                   \
        .choice = (const char *const[]){plain, set, NULL}, .kinds = DEA_KEY_BOTH, .accepted = plain ", " set                     \
    }

/* The axes over which a study repeats, in its own mapping. */
#define OVER(name)                                                                                                               \
    {                                                                                                                            \
        .path = name, .read = dea_read_later, .offset = DEA_KEY_NOWHERE, .kinds = DEA_KEY_BOTH, .within = name,                  \
        .accepted = "a mapping of axes, e.g. {coverage: [0.25, 0.5]}"                                                            \
    }

#endif
