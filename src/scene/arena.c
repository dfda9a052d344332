#include "scene/tree.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK_SIZE = 16384, ALIGNMENT = 16 };

struct dea_arena_block {
    dea_arena_block *next;
    size_t used;
    size_t size;
    _Alignas(ALIGNMENT) char bytes[];
};

static dea_arena_block *block_add(dea_arena *arena, size_t size)
{
    if (size > SIZE_MAX - sizeof(dea_arena_block)) {
        return NULL;
    }
    dea_arena_block *block = calloc(1, sizeof *block + size);
    if (block) {
        block->size = size;
        block->next = arena->blocks;
        arena->blocks = block;
    }
    return block;
}

void *dea_arena_take(dea_arena *arena, size_t size)
{
    dea_arena_block *block = arena->blocks;
    if (size > SIZE_MAX - ALIGNMENT) {
        return NULL;
    }
    const size_t rounded = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    if (!block || block->size - block->used < rounded) {
        block = block_add(arena, rounded > BLOCK_SIZE ? rounded : BLOCK_SIZE);
    }
    if (!block) {
        return NULL;
    }
    void *memory = block->bytes + block->used;
    block->used += rounded;
    return memory;
}

char *dea_arena_copy(dea_arena *arena, const char *text, size_t length)
{
    char *copy = length < SIZE_MAX ? dea_arena_take(arena, length + 1) : NULL;
    if (copy && length > 0) {
        memcpy(copy, text, length);
    }
    return copy;
}

void dea_arena_free(dea_arena *arena)
{
    while (arena->blocks) {
        dea_arena_block *next = arena->blocks->next;
        free(arena->blocks);
        arena->blocks = next;
    }
}
