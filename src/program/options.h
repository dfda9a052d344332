/** @file options.h
 * The options of all commands: one table that parsing and completion work from.
 */
#ifndef DEA_PROGRAM_OPTIONS_H
#define DEA_PROGRAM_OPTIONS_H

#include "program/program.h"

typedef struct dea_option dea_option;

/** What takes an option, how its value is read, and where that goes. */
struct dea_option {
    const char *name;
    char letter;       /**< 0: none */
    const char *value; /**< what its value is called, FILE: a file; NULL: takes none */
    dea_word *words;   /**< values that it accepts, NULL: others too */
    const char *about; /**< what it does, for help and completion */
    unsigned group;    /**< dea_takes; 0: every command */
    bool (*take)(const dea_option *option, const char *value, dea_arguments *arguments); /**< false, with a complaint */
    size_t offset;                                                                       /**< of its place in dea_arguments */
    const char *unit;                                                                    /**< of a quantity, "1": a number */
    double low, high;                                                                    /**< range of a number */
    bool closed;                                                                         /**< its low end is part of it */
    const char *needs;                                                                   /**< for messages: what is accepted */
};

/** Option number @p index of those that the command takes, NULL past the end. */
const dea_option *dea_option_at(const dea_command *command, size_t index);

#endif
