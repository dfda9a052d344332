/* Memory of one reading: taken piece by piece, freed at once. */
#ifndef DEA_SCENE_ARENA_H
#define DEA_SCENE_ARENA_H

#include <stddef.h>

typedef struct dea_arena_block dea_arena_block;

/* Start with {0}; end with dea_arena_free(). */
typedef struct dea_arena {
    dea_arena_block *blocks;
} dea_arena;

/* Zeroed memory that lives until dea_arena_free(), NULL without memory. */
void *dea_arena_take(dea_arena *arena, size_t size);
/* NUL-terminated copy of @p length bytes, NULL without memory. */
char *dea_arena_copy(dea_arena *arena, const char *text, size_t length);
/* Frees all that was taken. */
void dea_arena_free(dea_arena *arena);

#endif
