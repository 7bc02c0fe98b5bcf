#include "server/cli/command_tree.h"

#include <algorithm>
#include <cctype>
#include <exception>
#include <iostream>
#include <string_view>

#include "api/describe/suggest.h"

namespace tunewright::server {

namespace {

constexpr int kUsage = 2;

/// All errors of the command line have one form.
int usage_error(std::string sentence, const CLI::App* command) {
    if (sentence.empty() || std::string_view(".?!").find(sentence.back()) == std::string_view::npos) sentence += ".";
    const std::string name = command ? command->get_name() + " " : "";
    std::cerr << "tunewright: " << sentence << " `tunewright " << name << "--help` lists the possibilities.\n";
    return kUsage;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
    const std::string meant = api::nearest(word, known);
    return meant.empty() ? "" : " Did you mean " + meant + "?";
}

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

/// The names of the options as typed, without the hyphens.
std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* each : command.get_options())
        for (const std::string& name : each->get_lnames()) names.push_back(name);
    return names;
}

std::string of_unknown_word(const std::string& word, const CLI::App& command) {
    if (word.starts_with("--")) {
        const std::string name = word.substr(2, word.find('=') - 2);
        const std::string meant = api::nearest(name, option_names(command));
        return command.get_name() + " has no option --" + name + "." +
               (meant.empty() ? "" : " Did you mean --" + meant + "?");
    }
    return word.starts_with("-") ? command.get_name() + " has no option " + word
                                 : "\"" + word + "\" is more than " + command.get_name() + " takes";
}

}  // namespace

CommandTree::CommandTree()
    : app_("Tunes PID controllers for a plant or a recorded test, and evaluates their robustness.") {
    app_.name("tunewright");
    app_.set_version_flag("--version", "tunewright " TUNEWRIGHT_VERSION);
    app_.require_subcommand(1);
}

CLI::App& CommandTree::add(const std::string& name, const std::string& help, std::function<int()> action) {
    CLI::App* command = app_.add_subcommand(name, help);
    actions_.emplace_back(command, std::move(action));
    return *command;
}

int CommandTree::run(int argc, char** argv) {
    const std::vector<std::string> names = command_names(app_);
    const std::string first = argc > 1 ? argv[1] : "";
    if (first.empty()) return usage_error("name a command: " + api::listed(names), nullptr);
    if (!first.starts_with("-") && std::find(names.begin(), names.end(), first) == names.end())
        return usage_error("there is no command \"" + first + "\"." + did_you_mean(first, names), nullptr);
    try {
        app_.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app_.exit(error);  // help or version
        const std::vector<CLI::App*> named = app_.get_subcommands();
        const CLI::App* command = named.empty() ? nullptr : named.front();
        const std::vector<std::string> unknown = command ? command->remaining() : std::vector<std::string>{};
        return usage_error(unknown.empty() ? error.what() : of_unknown_word(unknown.front(), *command), command);
    }
    try {
        for (const auto& [command, action] : actions_)
            if (command->parsed()) return action();
    } catch (const std::exception& fault) {
        std::cerr << "tunewright: " << fault.what() << "\n";
        return 1;
    }
    return kUsage;
}

std::string variable_of(const std::string& name) {
    std::string variable = "TUNEWRIGHT_";
    for (const char c : name)
        variable.push_back(c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c))));
    return variable;
}

namespace {

constexpr std::string_view kPrefix = "TUNEWRIGHT_";

bool is_of_kubernetes(std::string_view name, std::string_view value) {
    return name.find("_SERVICE_") != std::string_view::npos || name.find("_PORT_") != std::string_view::npos ||
           value.starts_with("tcp://");
}

}  // namespace

std::vector<std::string> strange_variables(const std::vector<std::string>& environment,
                                           const std::vector<std::string>& known) {
    std::vector<std::string> endings;
    for (const std::string& name : known) endings.push_back(name.substr(kPrefix.size()));
    std::vector<std::string> sentences;
    for (const std::string& variable : environment) {
        const std::string name = variable.substr(0, variable.find('='));
        const std::string_view value = std::string_view(variable).substr(std::min(name.size() + 1, variable.size()));
        if (!name.starts_with(kPrefix) || std::ranges::find(known, name) != known.end()) continue;
        if (is_of_kubernetes(name, value)) continue;
        const std::string meant = api::nearest(name.substr(kPrefix.size()), endings);
        std::string sentence = "the variable " + name + " is set, but there is no such setting.";
        sentence += meant.empty() ? " `tunewright serve --help` names all"
                                  : " Did you mean " + std::string(kPrefix) + meant + "?";
        sentences.push_back(std::move(sentence));
    }
    return sentences;
}

}  // namespace tunewright::server
