// `tunewright completion` and `tunewright manual`: texts for a shell and for man, generated from the tree of commands,
// so that they always agree with it.
#include <algorithm>
#include <sstream>

#include "server/cli/command_tree.h"
#include "server/cli/output.h"

namespace tunewright::server {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

/// True if a value follows the option.
bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// The option as typed, "--Ms", or "" for a positional argument.
std::string typed_name(const CLI::Option& option) {
    return option.get_lnames().empty() ? "" : "--" + option.get_lnames().front();
}

std::string value_name(const CLI::Option& option) {
    const std::string name = option.get_type_name();
    return name.empty() ? "VALUE" : name;
}

std::string joined_options(const CLI::App& command) {
    std::string out;
    for (const CLI::Option* option : command.get_options())
        if (const std::string name = typed_name(*option); !name.empty()) out += (out.empty() ? "" : " ") + name;
    return out;
}

void write_bash(const CLI::App& app, std::ostream& out) {
    std::string names;
    for (const CLI::App* command : commands_of(app)) names += (names.empty() ? "" : " ") + command->get_name();
    out << "# bash completion for tunewright\n"
           "_tunewright() {\n"
           "    local word=${COMP_WORDS[COMP_CWORD]} options\n"
           "    if [ \"$COMP_CWORD\" = 1 ]; then\n"
           "        mapfile -t COMPREPLY < <(compgen -W '"
        << names << " " << joined_options(app)
        << "' -- \"$word\")\n"
           "        return\n"
           "    fi\n"
           "    case ${COMP_WORDS[1]} in\n";
    for (const CLI::App* command : commands_of(app))
        out << "        " << command->get_name() << ") options='" << joined_options(*command) << "' ;;\n";
    out << "        *) options='' ;;\n"
           "    esac\n"
           "    case $word in\n"
           "        -*) mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$word\") ;;\n"
           "        *) mapfile -t COMPREPLY < <(compgen -f -- \"$word\") ;;\n"
           "    esac\n"
           "}\n"
           "complete -o filenames -F _tunewright tunewright\n";
}

/// Escapes a text for a place between single quotes in which a colon and brackets have a meaning.
std::string zsh_text(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '\'') {
            out += "'\\''";
            continue;
        }
        if (c == ':' || c == '[' || c == ']' || c == '\\') out += '\\';
        out += c;
    }
    return out;
}

void write_zsh(const CLI::App& app, std::ostream& out) {
    out << "#compdef tunewright\n"
           "_tunewright() {\n"
           "    local -a commands\n"
           "    commands=(\n";
    for (const CLI::App* command : commands_of(app))
        out << "        '" << command->get_name() << ":" << zsh_text(command->get_description()) << "'\n";
    out << "    )\n"
           "    if (( CURRENT == 2 )); then\n"
           "        _describe command commands\n"
           "        return\n"
           "    fi\n"
           "    local command=$words[2]\n"
           "    shift words\n"
           "    (( CURRENT-- ))\n"
           "    case $command in\n";
    for (const CLI::App* command : commands_of(app)) {
        out << "        " << command->get_name() << ")\n            _arguments";
        for (const CLI::Option* option : command->get_options()) {
            const std::string name = typed_name(*option);
            if (name.empty()) continue;
            out << " \\\n                '" << name << "[" << zsh_text(option->get_description()) << "]"
                << (takes_value(*option) ? ":" + zsh_text(value_name(*option)) + ":_files" : "") << "'";
        }
        out << " \\\n                '*:file:_files' ;;\n";
    }
    out << "    esac\n"
           "}\n"
           "if [ \"$funcstack[1]\" = _tunewright ]; then\n"
           "    _tunewright \"$@\"\n"
           "else\n"  // the script is sourced
           "    compdef _tunewright tunewright\n"
           "fi\n";
}

/// Escapes a line of troff: a backslash and a hyphen stay letters, and a dot at the beginning is not a request.
std::string troff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
    }
    return out.starts_with(".") || out.starts_with("'") ? "\\&" + out : out;
}

void write_option(const CLI::Option& option, std::ostream& out) {
    const std::string name = typed_name(option);
    out << ".TP\n";
    if (name.empty()) {
        out << ".I " << troff(option.get_name(true)) << "\n";
    } else {
        out << ".BR " << troff(name);
        if (takes_value(option)) out << " \" \" \\fI" << troff(value_name(option)) << "\\fR";
        out << "\n";
    }
    out << troff(option.get_description());
    if (!option.get_default_str().empty()) out << " (default: " << troff(option.get_default_str()) << ")";
    out << ".\n";
    if (!option.get_envname().empty()) out << "Environment: " << troff(option.get_envname()) << ".\n";
}

void write_manual(const CLI::App& app, std::ostream& out) {
    out << ".TH TUNEWRIGHT 1 \"\" \"tunewright " TUNEWRIGHT_VERSION
           "\" \"User Commands\"\n"
           ".SH NAME\n"
           "tunewright \\- tunes PID controllers\n"
           ".SH SYNOPSIS\n"
           ".B tunewright\n"
           ".I COMMAND\n"
           "[\\fIWORD\\fR ...]\n"
           ".SH DESCRIPTION\n"
        << troff(app.get_description())
        << "\nOn a terminal the commands answer with short tables; elsewhere, or with \\-\\-json or \\-\\-pretty, with "
           "JSON.\nFiles named \\- are standard input.\n"
           ".SH COMMANDS\n";
    for (const CLI::App* command : commands_of(app)) {
        out << ".SS " << troff(command->get_name()) << "\n" << troff(command->get_description()) << ".\n";
        for (const CLI::Option* option : command->get_options())
            if (option != command->get_help_ptr()) write_option(*option, out);
    }
    out << ".SH EXIT STATUS\n"
           ".TP\n.B 0\nAn answer, on standard output.\n"
           ".TP\n.B 1\nAn invalid or failed request, on standard error: sentences on a terminal, JSON elsewhere.\n"
           ".TP\n.B 2\nAn argument of the command line, or an option of the service, is invalid.\n"
           ".TP\n.B 3\nThe service cannot open its port.\n"
           ".TP\n.B 4\nThe service cannot open its store.\n"
           ".SH EXAMPLES\n"
           ".EX\n"
           "tunewright tune \\-\\-plant \"2 e^(\\-3s)/(10s+1)\" \\-\\-Ms 1.6 \\-\\-plot\n"
           "tunewright tune step.csv \\-\\-u valve \\-\\-y level\n"
           "tunewright examples 3 | tunewright tune \\- \\-\\-table\n"
           "tunewright serve \\-\\-listen 127.0.0.1:8080\n"
           ".EE\n";
}

}  // namespace

void add_tree_commands(CommandTree& tree) {
    CLI::App& app = tree.app();
    std::string& shell = tree.keep<std::string>();
    tree.add("completion", "Completion of the command line for a shell",
             [&] {
                 std::ostringstream out;
                 shell == "zsh" ? write_zsh(app, out) : write_bash(app, out);
                 return write_text(out.str());
             })
        .add_option("shell", shell, "bash or zsh")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh"}));
    tree.add("manual", "The manual page, for man: tunewright manual | man -l -", [&] {
        std::ostringstream out;
        write_manual(app, out);
        return write_text(out.str());
    });
}

}  // namespace tunewright::server
