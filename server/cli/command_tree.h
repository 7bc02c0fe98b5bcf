// The command line as a tree: commands with their options, what each does, and how a word that is wrong is answered.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tunewright::server {

class CommandTree {
public:
    CommandTree();
    CommandTree(const CommandTree&) = delete;
    CommandTree& operator=(const CommandTree&) = delete;

    /// A command; `action` is called once its words are known, and returns the exit code of the process.
    CLI::App& add(const std::string& name, const std::string& help, std::function<int()> action);

    /// Words of a command, which live as long as the tree.
    template <class Words>
    Words& keep(Words words = {}) {
        auto kept = std::make_shared<Words>(std::move(words));
        kept_.push_back(kept);
        return *kept;
    }

    CLI::App& app() { return app_; }

    /// Runs the command that the words name and returns its exit code; 0 for a help or the version; 2 where a word
    /// cannot be used, and standard error has the sentence that says why.
    int run(int argc, char** argv);

private:
    CLI::App app_;
    std::vector<std::pair<CLI::App*, std::function<int()>>> actions_;
    std::vector<std::shared_ptr<void>> kept_;
};

/// Each option of a service and of an operator's command has a variable of the same name: --max-body is
/// TUNEWRIGHT_MAX_BODY.
std::string variable_of(const std::string& name);
/// A sentence for each variable of `environment` ("NAME=VALUE") that begins as those do and is none of `known`.
/// Kubernetes' variables about a service of that name are left out.
std::vector<std::string> strange_variables(const std::vector<std::string>& environment,
                                           const std::vector<std::string>& known);

template <class T>
CLI::Option* option(CLI::App& app, const std::string& name, T& value, const std::string& help) {
    return app.add_option("--" + name, value, help)->envname(variable_of(name));
}

/// The commands of one file each.
void add_serve_command(CommandTree& tree);
void add_loop_commands(CommandTree& tree);
void add_list_commands(CommandTree& tree);
void add_operator_commands(CommandTree& tree);
/// `completion` and `manual`, which say what the tree holds when they are called.
void add_tree_commands(CommandTree& tree);

}  // namespace tunewright::server
