// The command line as a tree: commands with their options, their actions, and the answer to an argument that is wrong.
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

    /// Adds a command; `action` is called once its arguments are known, and returns the exit code of the process.
    CLI::App& add(const std::string& name, const std::string& help, std::function<int()> action);

    /// Arguments of a command, which live as long as the tree.
    template <class Words>
    Words& keep(Words words = {}) {
        auto kept = std::make_shared<Words>(std::move(words));
        kept_.push_back(kept);
        return *kept;
    }

    CLI::App& app() { return app_; }

    /// Runs the command and returns its exit code; 0 for help or version; 2 for an argument that cannot be used, with
    /// the reason on standard error.
    int run(int argc, char** argv);

private:
    CLI::App app_;
    std::vector<std::pair<CLI::App*, std::function<int()>>> actions_;
    std::vector<std::shared_ptr<void>> kept_;
};

/// The environment variable of an option of the service or of an operator's command: --max-body is TUNEWRIGHT_MAX_BODY.
std::string variable_of(const std::string& name);
/// A sentence for each variable of `environment` ("NAME=VALUE") with this prefix that is not one of `known`.
/// Kubernetes' variables about a service of that name are left out.
std::vector<std::string> strange_variables(const std::vector<std::string>& environment,
                                           const std::vector<std::string>& known);

template <class T>
CLI::Option* option(CLI::App& app, const std::string& name, T& value, const std::string& help) {
    return app.add_option("--" + name, value, help)->envname(variable_of(name));
}

struct OutputWords;
/// Adds --json and --pretty, and --table if the command has a table.
void add_output_options(CLI::App& app, OutputWords& words, bool has_table);

/// Each adds the commands of one source file.
void add_serve_command(CommandTree& tree);
void add_loop_commands(CommandTree& tree);
void add_check_command(CommandTree& tree);
void add_list_commands(CommandTree& tree);
void add_mcp_command(CommandTree& tree);
void add_operator_commands(CommandTree& tree);
/// Adds `completion` and `manual`, which describe the tree at the time of the call.
void add_tree_commands(CommandTree& tree);

}  // namespace tunewright::server
