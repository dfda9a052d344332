/* Files that a scene names. */
#include <stdio.h>
#include <string.h>

#include "scene/reader.h"

dea_status dea_reader_names_file(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    char shown[DEA_TEXT_ROOM];
    if (reader->no_files) {
        return dea_place_fail(&node->place, reader->error, ref->path,
                              "names a file (%s), and none may be named here (--no-files)", dea_reader_show(node, shown));
    }
    return node->place.origin->folder ? DEA_OK : dea_reader_refuse(reader, ref, node, "files cannot be named here");
}

char *dea_reader_path(dea_reader *reader, const dea_node *node)
{
    const char *folder = node->text[0] == '/' ? "" : node->place.origin->folder;
    const size_t room = strlen(folder) + strlen(node->text) + 2;
    char *path = dea_arena_take(&reader->arena, room);
    if (path) {
        snprintf(path, room, "%s%s%s", folder, folder[0] ? "/" : "", node->text);
    }
    return path;
}

dea_origin *dea_reader_origin(dea_reader *reader, const char *path)
{
    char shown[10 * 256 + 8];
    const char *slash = strrchr(path, '/');
    dea_origin *origin = dea_arena_take(&reader->arena, sizeof *origin);
    dea_text_clip(path, 256, shown, sizeof shown);
    if (origin) {
        origin->name = dea_arena_copy(&reader->arena, shown, strlen(shown));
        origin->folder = slash == path ? "/" : slash ? dea_arena_copy(&reader->arena, path, (size_t)(slash - path)) : ".";
    }
    return origin && origin->name && origin->folder ? origin : NULL;
}
