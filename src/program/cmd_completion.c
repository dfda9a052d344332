/* Completion for shells, from the tables of commands and options. */
#include <stdio.h>
#include <string.h>

#include "program/options.h"

/* A shell, and how its completion is written. */
typedef struct shell {
    const char *name;
    void (*write)(FILE *out);
} shell;

/* Words with blanks between, each with @p ending. */
static void write_words(FILE *out, dea_word *words, const char *ending)
{
    char room[DEA_NAME_LENGTH];
    for (size_t i = 0; words && words(i, room); i++) {
        fprintf(out, "%s%s%s", i > 0 ? " " : "", words(i, room), ending);
    }
}

/* Text between single quotes; one of its own is written as @p quote. */
static void write_text(FILE *out, const char *text, const char *quote)
{
    for (; *text; text++) {
        if (*text == '\'') {
            fputs(quote, out);
        } else {
            fputc(*text, out);
        }
    }
}

/* "=" after a key, whose value comes next. */
static const char *ending_of(const dea_option *option)
{
    return strchr(option->value, '=') ? "=" : "";
}

static bool is_file(const dea_option *option)
{
    return option->value && strcmp(option->value, "FILE") == 0;
}

/* Calls @p each once for every option of any command. */
static void options_visit(FILE *out, void (*each)(FILE *out, const dea_option *option))
{
    const dea_command all = {.takes = ~0u};
    for (size_t i = 0; dea_option_at(&all, i); i++) {
        each(out, dea_option_at(&all, i));
    }
}

/* ---- bash */

static void bash_option(FILE *out, const dea_option *option)
{
    char letter[8] = "";
    if (!option->value) {
        return;
    }
    if (option->letter) {
        snprintf(letter, sizeof letter, "-%c|", option->letter);
    }
    fprintf(out, "    %s--%s) ", letter, option->name);
    if (option->words) {
        fputs("files=0 words='", out);
        write_words(out, option->words, "");
        fputs("' ;;\n", out);
    } else {
        fputs(is_file(option) ? "ending='' files=1 ;;\n" : "return ;;\n", out);
    }
}

static void bash_command(FILE *out, const dea_command *command)
{
    fprintf(out, "    %s) options='", command->name);
    for (size_t i = 0; dea_option_at(command, i); i++) {
        fprintf(out, "%s--%s", i > 0 ? " " : "", dea_option_at(command, i)->name);
    }
    fputs("' operands='", out);
    write_words(out, command->words, "");
    fprintf(out, "' ending='%s' files=%d ;;\n", command->files ? command->files : "", command->files ? 1 : 0);
}

static void bash_write(FILE *out)
{
    fputs("# Completion of deaspice for bash, made by: deaspice completion bash\n"
          "_deaspice()\n"
          "{\n"
          "    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
          "    local words='' options='' operands='' ending='' files=0\n"
          "    COMPREPLY=()\n"
          "    [ \"$current\" = = ] && current=''\n"
          "    [ \"$before\" = = ] && [ \"${COMP_WORDS[COMP_CWORD-3]}\" = --set ] && return\n"
          "    [ \"$before\" = = ] && before=${COMP_WORDS[COMP_CWORD-2]}\n"
          "    case ${COMP_WORDS[1]} in\n",
          out);
    for (size_t i = 0; dea_command_at(i); i++) {
        bash_command(out, dea_command_at(i));
    }
    fputs("    esac\n"
          "    if [ \"$COMP_CWORD\" -eq 1 ] || [ \"${COMP_WORDS[1]} $COMP_CWORD\" = 'help 2' ]; then\n"
          "        before='' files=0 words='help",
          out);
    for (size_t i = 0; dea_command_at(i); i++) {
        fprintf(out, " %s", dea_command_at(i)->name);
    }
    fputs("'\n"
          "    fi\n"
          "    case $before in\n",
          out);
    options_visit(out, bash_option);
    fputs("    *)\n"
          "        case $current in\n"
          "        -*) words=$options files=0 ;;\n"
          "        *) words=${words:-$operands} ;;\n"
          "        esac ;;\n"
          "    esac\n"
          "    if [ \"$before\" = --set ]; then\n"
          "        compopt -o nospace 2>/dev/null\n"
          "        mapfile -t COMPREPLY < <(compgen -S = -W \"$words\" -- \"$current\")\n"
          "        return\n"
          "    fi\n"
          "    mapfile -t COMPREPLY < <(\n"
          "        compgen -W \"$words\" -- \"$current\"\n"
          "        if [ \"$files\" = 1 ]; then\n"
          "            compgen -f -X \"!*$ending\" -- \"$current\"\n"
          "            [ -n \"$ending\" ] && compgen -d -- \"$current\"\n"
          "        fi)\n"
          "    [ \"$files\" = 0 ] || compopt -o filenames 2>/dev/null\n"
          "}\n"
          "complete -F _deaspice deaspice\n",
          out);
}

/* ---- zsh */

static const char zsh_quote[] = "'\\''";

static void zsh_option(FILE *out, const dea_option *option)
{
    if (option->letter) {
        fprintf(out, " '(-%c --%s)'{-%c,--%s%s}", option->letter, option->name, option->letter, option->name,
                option->value ? "=" : "");
    } else {
        fprintf(out, " '%s--%s%s", option->words && strchr(option->value, '=') ? "*" : "", option->name,
                option->value ? "=" : "");
    }
    fputs(option->letter ? "'[" : "[", out);
    write_text(out, option->about, zsh_quote);
    fputc(']', out);
    if (option->value) {
        fprintf(out, ":%s:", option->value);
        if (is_file(option)) {
            fputs("_files", out);
        } else if (option->words) {
            fputc('(', out);
            write_words(out, option->words, ending_of(option));
            fputc(')', out);
        }
    }
    fputc('\'', out);
}

static void zsh_command(FILE *out, const dea_command *command)
{
    fprintf(out, "    %s) _arguments", command->name);
    for (size_t i = 0; dea_option_at(command, i); i++) {
        zsh_option(out, dea_option_at(command, i));
    }
    if (command->words) {
        fputs(command->files ? " '*: :{_alternative \"words:name:(" : " '*:name:(", out);
        write_words(out, command->words, "");
        fputs(command->files ? ")\" \"files:file:_files\"}'" : ")'", out);
    } else {
        fprintf(out, " '*:file:_files -g \"*%s\"'", command->files);
    }
    fputs(" ;;\n", out);
}

static void zsh_write(FILE *out)
{
    fputs("#compdef deaspice\n"
          "# Completion of deaspice for zsh, made by: deaspice completion zsh\n"
          "_deaspice()\n"
          "{\n"
          "    local -a commands=('help:tell what a command does'",
          out);
    for (size_t i = 0; dea_command_at(i); i++) {
        fprintf(out, " '%s:", dea_command_at(i)->name);
        write_text(out, dea_command_at(i)->summary, zsh_quote);
        fputc('\'', out);
    }
    fputs(")\n"
          "    if (( CURRENT == 2 )) || [[ $words[2] == help ]]; then\n"
          "        _describe command commands\n"
          "        return\n"
          "    fi\n"
          "    shift words\n"
          "    (( CURRENT-- ))\n"
          "    case $words[1] in\n",
          out);
    for (size_t i = 0; dea_command_at(i); i++) {
        zsh_command(out, dea_command_at(i));
    }
    fputs("    esac\n"
          "}\n"
          "if [[ $funcstack[1] == _deaspice ]]; then _deaspice \"$@\"; else compdef _deaspice deaspice; fi\n",
          out);
}

/* ---- fish */

static const char fish_quote[] = "\\'";

static void fish_option(FILE *out, const char *command, const dea_option *option)
{
    fprintf(out, "complete -c deaspice -n '__fish_seen_subcommand_from %s' -l %s", command, option->name);
    if (option->letter) {
        fprintf(out, " -s %c", option->letter);
    }
    if (option->value) {
        fputs(is_file(option) ? " -r -F" : " -x", out);
    }
    if (option->words) {
        fputs(" -a '", out);
        write_words(out, option->words, ending_of(option));
        fputc('\'', out);
    }
    fputs(" -d '", out);
    write_text(out, option->about, fish_quote);
    fputs("'\n", out);
}

static void fish_command(FILE *out, const dea_command *command)
{
    fprintf(out, "complete -c deaspice -n __fish_use_subcommand -a %s -d '", command->name);
    write_text(out, command->summary, fish_quote);
    fputs("'\n", out);
    for (size_t i = 0; dea_option_at(command, i); i++) {
        fish_option(out, command->name, dea_option_at(command, i));
    }
    if (command->words) {
        fprintf(out, "complete -c deaspice -n '__fish_seen_subcommand_from %s' -a '", command->name);
        write_words(out, command->words, "");
        fputs("'\n", out);
    }
    if (command->files) {
        fprintf(out, "complete -c deaspice -n '__fish_seen_subcommand_from %s' -F\n", command->name);
    }
}

static void fish_write(FILE *out)
{
    fputs("# Completion of deaspice for fish, made by: deaspice completion fish\n"
          "complete -c deaspice -f\n"
          "complete -c deaspice -n __fish_use_subcommand -a help -d 'tell what a command does'\n",
          out);
    for (size_t i = 0; dea_command_at(i); i++) {
        fish_command(out, dea_command_at(i));
        fprintf(out, "complete -c deaspice -n '__fish_seen_subcommand_from help' -a %s\n", dea_command_at(i)->name);
    }
}

static const shell shells[] = {{"bash", bash_write}, {"zsh", zsh_write}, {"fish", fish_write}};

enum { SHELLS = sizeof shells / sizeof *shells };

static const char *shell_word(size_t index, char room[DEA_NAME_LENGTH])
{
    (void)room;
    return index < SHELLS ? shells[index].name : NULL;
}

static const shell *shell_find(const char *name)
{
    size_t index;
    return dea_word_choose("shell", name, shell_word, &index) ? &shells[index] : NULL;
}

static dea_exit run(const dea_arguments *arguments)
{
    const shell *given = shell_find(arguments->operands[0].path);
    if (!given) {
        return DEA_EXIT_USAGE;
    }
    given->write(stdout);
    return DEA_EXIT_DONE;
}

const dea_command dea_command_completion = {
    .name = "completion",
    .summary = "a script that completes commands and options in a shell",
    .help = "Usage: deaspice completion SHELL\n"
            "\n"
            "Writes the completion for bash, zsh or fish to standard output. make install puts\n"
            "them where the shells look.\n"
            "\n",
    .further = "Examples:\n"
               "  source <(deaspice completion bash)     in ~/.bashrc; the same with zsh in ~/.zshrc\n"
               "  deaspice completion fish | source      in ~/.config/fish/config.fish\n",
    .takes = 0,
    .least = 1,
    .most = 1,
    .words = shell_word,
    .run = run,
};
