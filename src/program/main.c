#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sundials/sundials_config.h>
#include <unistd.h>

#include "program/program.h"
#include "support/text.h"

#ifndef DEA_VERSION
#define DEA_VERSION "unknown"
#endif

static const dea_command *const commands[] = {&dea_command_run,       &dea_command_merge,  &dea_command_check,
                                              &dea_command_bench,     &dea_command_export, &dea_command_fit,
                                              &dea_command_materials, &dea_command_init,   &dea_command_completion};

enum { COMMANDS = sizeof commands / sizeof commands[0] };

const dea_command *dea_command_at(size_t index)
{
    return index < COMMANDS ? commands[index] : NULL;
}

static void print_usage(FILE *out)
{
    fputs("Usage: deaspice COMMAND [OPTION]... [FILE]...\n"
          "\n"
          "Simulates dielectric elastomer actuators as networks and as membranes.\n"
          "\n"
          "Commands:\n",
          out);
    for (size_t i = 0; i < COMMANDS; i++)
        fprintf(out, "  %-10s %s\n", commands[i]->name, commands[i]->summary);
    fputs("\n"
          "Engines:\n",
          out);
    for (size_t i = 0; i < dea_engine_count(); i++)
        fprintf(out, "  %-10s %s\n", dea_engine_at(i)->name, dea_engine_at(i)->summary);
    fputs("\n"
          "deaspice help COMMAND tells more about a command, deaspice --version the version.\n"
          "Exit status: 0 done, 1 a run failed, 2 usage or a bad scene, 3 a check disagreed.\n",
          out);
}

static void print_version(void)
{
    printf("deaspice %s (built for SUNDIALS %s; engines:", DEA_VERSION, SUNDIALS_VERSION); /* loads nothing */
    for (size_t i = 0; i < dea_engine_count(); i++)
        printf(" %s", dea_engine_at(i)->name);
    puts(")");
}

static const dea_command *command_find(const char *name)
{
    const char *names[COMMANDS];
    for (size_t i = 0; i < COMMANDS; i++) {
        names[i] = commands[i]->name;
        if (strcmp(names[i], name) == 0)
            return commands[i];
    }
    if (access(name, F_OK) == 0)
        dea_complain("\"%s\" is a file; the command comes first, for example deaspice run %s", name, name);
    else
        dea_complain_unknown("command", name, names, COMMANDS);
    return NULL;
}

static dea_exit command_run(const dea_command *command, int argc, char **argv)
{
    dea_arguments arguments;
    dea_exit outcome = DEA_EXIT_USAGE;
    switch (dea_arguments_parse(command, argc, argv, &arguments)) {
    case DEA_PARSED_FINE:
        outcome = command->run(&arguments);
        break;
    case DEA_PARSED_HELP:
        dea_help_print(command);
        outcome = DEA_EXIT_DONE;
        break;
    case DEA_PARSED_VERSION:
        print_version();
        outcome = DEA_EXIT_DONE;
        break;
    case DEA_PARSED_WRONG:
        break;
    }
    dea_arguments_free(&arguments);
    return outcome;
}

/* deaspice help, or deaspice help COMMAND. */
static dea_exit help(const char *name)
{
    const dea_command *command = name ? command_find(name) : NULL;
    if (name && !command)
        return DEA_EXIT_USAGE;
    if (command)
        dea_help_print(command);
    else
        print_usage(stdout);
    return DEA_EXIT_DONE;
}

/* An option before any command. */
static dea_exit option_alone(const char *option)
{
    static const char *const names[] = {"--help", "--version"};
    if (strcmp(option, names[0]) == 0 || strcmp(option, "-h") == 0)
        return help(NULL);
    if (strcmp(option, names[1]) == 0 || strcmp(option, "-V") == 0) {
        print_version();
        return DEA_EXIT_DONE;
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (dea_text_likely(names[i] + 2, dea_text_distance(option, names[i]))) {
            dea_complain_unknown("option", option, names, sizeof names / sizeof *names);
            return DEA_EXIT_USAGE;
        }
    }
    dea_complain("the command comes first: deaspice COMMAND %s ...; see deaspice --help", option);
    return DEA_EXIT_USAGE;
}

static dea_exit dispatch(int argc, char **argv)
{
    if (argc < 2) {
        print_usage(stderr);
        return DEA_EXIT_USAGE;
    }
    const char *first = argv[1];
    if (first[0] == '-')
        return option_alone(first);
    if (strcmp(first, "help") == 0)
        return help(argv[2]);
    const dea_command *command = command_find(first);
    return command ? command_run(command, argc - 1, argv + 1) : DEA_EXIT_USAGE;
}

int main(int argc, char **argv)
{
    signal(SIGXFSZ, SIG_IGN); /* a limit of file size is an error of the write, which can be told */
    dea_exit outcome = dispatch(argc, argv);
    bool failed = ferror(stdout) != 0;
    if ((fflush(stdout) != 0 || failed) && dea_signals_caught() == 0) {
        dea_complain("cannot write standard output: %s", errno ? strerror(errno) : "it failed");
        outcome = outcome == DEA_EXIT_DONE ? DEA_EXIT_FAILED : outcome;
    }
    dea_signals_raise();
    return (int)outcome;
}
