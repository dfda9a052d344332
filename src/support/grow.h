/* Arrays that grow. */
#ifndef DEA_SUPPORT_GROW_H
#define DEA_SUPPORT_GROW_H

#include <stdlib.h>

/* Room for one more of @p count items of so many bytes: the items, moved to twice the room where they fill it. NULL: out of memory,
 * and the items stay as they are. */
static inline void *dea_grow(void *items, size_t count, size_t *room, size_t size)
{
    if (count < *room) {
        return items;
    }
    const size_t more = *room > 0 ? 2 * *room : 64;
    void *longer = realloc(items, more * size);
    *room = longer ? more : *room;
    return longer;
}

#endif
