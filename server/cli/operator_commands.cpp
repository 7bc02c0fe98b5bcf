// The commands for the operator of the service: keys, secrets, stores, health.
#include <exception>
#include <iostream>
#include <stdexcept>

#include "server/access/keys.h"
#include "server/cli/command_tree.h"
#include "server/cli/commands.h"
#include "server/config.h"
#include "server/notify/secrets.h"
#include "server/serve.h"
#include "server/store/open_store.h"

namespace tunewright::server {
namespace {

void add_key_command(CommandTree& tree) {
    KeyCommand& words = tree.keep<KeyCommand>();
    CLI::App& app = tree.add("key", "Make an API key: printed once on stdout, its digest kept in a file",
                             [&] { return make_key(words); });
    app.add_option("name", words.name, "Name of the owner, to whom jobs belong")->required();
    app.add_option("--keys", words.file, "The file it is added to (default: the line goes to stderr)")
        ->type_name("FILE");
    app.add_flag("--admin", words.admin, "For operators: can see and change all jobs");
    app.add_flag("--rotate", words.rotate,
                 "Add a second key for the same name; the old one works until its line is deleted");
}

void add_secret_command(CommandTree& tree) {
    SecretCommand& words = tree.keep<SecretCommand>();
    CLI::App& app = tree.add("secret", "Make a secret that signs notifications: printed on stdout, kept in a file",
                             [&] { return make_secret(words); });
    app.add_option("name", words.name, "Its name, which a request gives as notify.secret_id")->required();
    app.add_option("--file", words.file, "The file it is added to (default: the line goes to stderr)")
        ->type_name("FILE");
}

int failed(int code, const std::exception& fault) {
    std::cerr << "tunewright: " << fault.what() << "\n";
    return code;
}

void add_migrate_command(CommandTree& tree) {
    MigrateCommand& words = tree.keep<MigrateCommand>();
    words.store = Config{}.store;
    CLI::App& app = tree.add("migrate", "Migrate the tables of a store and list the changes", [&] {
        try {
            migrate_store(words, std::cout);
        } catch (const std::invalid_argument& error) {
            return failed(kBadConfiguration, error);
        } catch (const std::exception& fault) {
            return failed(kStoreFailed, fault);
        }
        return 0;
    });
    option(app, "store", words.store, "The store, as for `serve`")->capture_default_str();
    app.add_option("--grant", words.grant, "A role of PostgreSQL that may then run the service")->type_name("ROLE");
    app.add_flag("--compact", words.compact, "Rewrite a SQLite file without the space of deleted jobs");
}

struct HealthWords {
    std::string url, listen = Config{}.listen;
};

void add_health_command(CommandTree& tree) {
    HealthWords& words = tree.keep<HealthWords>();
    CLI::App& app = tree.add("health", "Check the health of a running service: exit code 0 if it is healthy",
                             [&] { return check_health(words.url.empty() ? health_url(words.listen) : words.url); });
    app.add_option("url", words.url, "Default: /healthz of this machine's service, by TUNEWRIGHT_LISTEN");
    option(app, "listen", words.listen, "HOST:PORT of that service");
}

}  // namespace

void add_operator_commands(CommandTree& tree) {
    add_key_command(tree);
    add_secret_command(tree);
    add_migrate_command(tree);
    add_health_command(tree);
}

}  // namespace tunewright::server
