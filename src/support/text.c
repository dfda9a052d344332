#include "support/text.h"

#include <ctype.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { WORD_MAX = 63 };

size_t dea_text_character(const char *text, size_t length, unsigned *code)
{
    static const unsigned smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char *bytes = (const unsigned char *)text;
    if (length == 0) {
        return 0;
    }
    if (bytes[0] < 0x80) {
        *code = bytes[0];
        return 1;
    }
    const size_t size = bytes[0] >= 0xF0 ? 4 : bytes[0] >= 0xE0 ? 3 : 2;
    if (bytes[0] < 0xC2 || bytes[0] > 0xF4 || size > length) {
        return 0;
    }
    unsigned value = bytes[0] & (0x7Fu >> size);
    for (size_t i = 1; i < size; i++) {
        if ((bytes[i] & 0xC0) != 0x80) {
            return 0;
        }
        value = value << 6 | (bytes[i] & 0x3Fu);
    }
    *code = value;
    return value >= smallest[size] && value <= 0x10FFFF && !(value >= 0xD800 && value <= 0xDFFF) ? size : 0;
}

size_t dea_text_letters(const char *text)
{
    size_t letters = 0;
    for (; *text; text++) {
        letters += ((unsigned char)*text & 0xC0) != 0x80;
    }
    return letters;
}

bool dea_text_hidden(unsigned code)
{
    return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x061C || (code >= 0x200B && code <= 0x200F) ||
           (code >= 0x2028 && code <= 0x202E) || (code >= 0x2060 && code <= 0x206F) || code == 0xFEFF;
}

char *dea_text_clip(const char *text, size_t shown, char *out, size_t room)
{
    const size_t length = strlen(text);
    size_t at = 0;
    size_t used = 0;
    for (; at < length && shown > 0 && used + 16 < room; shown--) {
        unsigned code = 0;
        const size_t size = dea_text_character(text + at, length - at, &code);
        if (size == 0) {
            used += (size_t)snprintf(out + used, room - used, "\\x%02X", (unsigned)(unsigned char)text[at]);
        } else if (dea_text_hidden(code)) {
            used += (size_t)snprintf(out + used, room - used, code < 0x100 ? "\\x%02X" : "\\u%04X", code);
        } else {
            memcpy(out + used, text + at, size);
            used += size;
        }
        at += size ? size : 1;
    }
    out[used] = '\0';
    if (at < length) {
        snprintf(out + used, room - used, "...");
    }
    return out;
}

const char *dea_text_line(const char *text, size_t length, int number, const char **stop)
{
    const char *end = text + length;
    for (int at = 1; at < number && text; at++) {
        const char *mark = memchr(text, '\n', (size_t)(end - text));
        text = mark ? mark + 1 : NULL;
    }
    if (text) {
        const char *mark = memchr(text, '\n', (size_t)(end - text));
        *stop = mark ? mark : end;
        *stop -= *stop > text && (*stop)[-1] == '\r';
    }
    return text;
}

int dea_text_column(const char *line, const char *at)
{
    int column = 1;
    for (const char *from = line; from < at; column++) {
        unsigned code = 0;
        const size_t size = dea_text_character(from, (size_t)(at - from), &code);
        from += size ? size : 1;
    }
    return column;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

size_t dea_text_distance(const char *a, const char *b)
{
    const size_t na = strlen(a);
    const size_t nb = strlen(b);
    size_t rows[3][WORD_MAX + 1];
    if (na > WORD_MAX || nb > WORD_MAX) {
        return SIZE_MAX;
    }
    for (size_t j = 0; j <= nb; j++) {
        rows[0][j] = j;
    }
    for (size_t i = 1; i <= na; i++) {
        size_t *row = rows[i % 3];
        const size_t *before = rows[(i + 2) % 3];
        const size_t *earlier = rows[(i + 1) % 3];
        row[0] = i;
        for (size_t j = 1; j <= nb; j++) {
            const int ca = tolower((unsigned char)a[i - 1]);
            const int cb = tolower((unsigned char)b[j - 1]);
            row[j] = least(least(before[j] + 1, row[j - 1] + 1), before[j - 1] + (ca != cb));
            if (i > 1 && j > 1 && ca == tolower((unsigned char)b[j - 2]) && cb == tolower((unsigned char)a[i - 2])) {
                row[j] = least(row[j], earlier[j - 2] + 1);
            }
        }
    }
    return rows[na % 3][nb];
}

bool dea_text_likely(const char *word, size_t distance)
{
    return distance <= (strlen(word) + 1) / 3;
}
