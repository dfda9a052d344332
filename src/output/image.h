/* Is a picture whole? A program that draws and does not look at what its writes return can leave a hole anywhere. */
#ifndef DEASPICE_OUTPUT_IMAGE_H
#define DEASPICE_OUTPUT_IMAGE_H

#include <stdbool.h>
#include <stddef.h>

/* PNG: every chunk with its checksum (RFC 2083, section 3), the last at the end. */
bool dea_image_png_whole(const char *bytes, size_t size);
/* SVG: every element that is opened is closed in its turn, the first one last; attributes have both quotes. */
bool dea_image_svg_whole(const char *text, size_t size);
/* PDF: its end is there, and every object stands where the table of objects says (ISO 32000-1, 7.5.4); of a compressed table only
 * that it stands there itself. The text ends with a NUL behind its @p size bytes. */
bool dea_image_pdf_whole(const char *text, size_t size);

#endif
