// The one binary.
#include "server/cli/command_tree.h"

int main(int argc, char** argv) {
    using namespace tunewright::server;
    CommandTree tree;
    add_serve_command(tree);
    add_loop_commands(tree);
    add_check_command(tree);
    add_list_commands(tree);
    add_mcp_command(tree);
    add_operator_commands(tree);
    add_tree_commands(tree);
    return tree.run(argc, argv);
}
