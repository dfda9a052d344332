/* Text of strangers: made fit for messages, compared for did-you-mean. */
#ifndef DEA_SUPPORT_TEXT_H
#define DEA_SUPPORT_TEXT_H

#include <stdbool.h>
#include <stddef.h>

/* Room for dea_text_clip() of DEA_TEXT_SHOWN characters. */
enum { DEA_TEXT_SHOWN = 60, DEA_TEXT_ROOM = 10 * DEA_TEXT_SHOWN + 8 };

/* Bytes of the valid UTF-8 character at @p text (1 ... 4) and its code point, 0 where there is none; @p text has @p length bytes.
 */
size_t dea_text_character(const char *text, size_t length, unsigned *code);
/* Characters of a text in UTF-8. */
size_t dea_text_letters(const char *text);
/* True for a character that a terminal or a reader could take for something else: controls, line separators, direction marks. */
bool dea_text_hidden(unsigned code);
/* Copies at most @p shown characters of @p text to @p out, hidden ones and foreign bytes escaped, "..." where it was cut; returns
 * @p out. */
char *dea_text_clip(const char *text, size_t shown, char *out, size_t room);
/* Start of line @p number of a text, counted from 1, and its end in @p stop, without line break; NULL where it has no such line.
 */
const char *dea_text_line(const char *text, size_t length, int number, const char **stop);
/* Column of @p at in the line that starts at @p line: characters before it and 1. */
int dea_text_column(const char *line, const char *at);
/* Edits between two words (insert, delete, replace, swap neighbours), case ignored; a large number where one is longer than 63
 * bytes. */
size_t dea_text_distance(const char *a, const char *b);
/* True where @p distance edits away is a likely slip of @p word. */
bool dea_text_likely(const char *word, size_t distance);

#endif
