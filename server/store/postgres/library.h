// Calls that differ between versions 6 and 7 of libpqxx, for the session and the listener only.
#pragma once

#include <functional>
#include <pqxx/connection>
#include <pqxx/nontransaction>
#include <pqxx/notification>
#include <pqxx/version>
#include <string>
#include <vector>
#if PQXX_VERSION_MAJOR < 7
#include <pqxx/binarystring>
#include <pqxx/errorhandler>
#include <pqxx/prepared_statement>
#else
#include <pqxx/params>
#endif

namespace tunewright::server::postgres {

/// A statement's text or the name of a prepared one, its values for $1, $2, ..., and after them bytes, if there are
/// any. Refers to its arguments.
struct Statement {
    const std::string& text;
    const std::vector<std::string>& values;
    const std::string* bytes = nullptr;
};

/// Called with the payload of each notification.
using PayloadHandler = std::function<void(const std::string&)>;

#if PQXX_VERSION_MAJOR < 7

/// Suppresses the server's notices on a connection.
using Quiet = pqxx::quiet_errorhandler;

inline pqxx::result execute(pqxx::nontransaction& on, const Statement& statement) {
    const auto values = pqxx::prepare::make_dynamic_params(statement.values);
    if (statement.bytes == nullptr) return on.exec_params(statement.text, values);
    return on.exec_params(statement.text, values, pqxx::binarystring(*statement.bytes));
}

inline pqxx::result execute_prepared(pqxx::nontransaction& on, const Statement& statement) {
    const auto values = pqxx::prepare::make_dynamic_params(statement.values);
    if (statement.bytes == nullptr) return on.exec_prepared(statement.text, values);
    return on.exec_prepared(statement.text, values, pqxx::binarystring(*statement.bytes));
}

/// Listens on a channel during its lifetime; the handler is called within get_notifs().
class Subscription : public pqxx::notification_receiver {
public:
    Subscription(pqxx::connection& connection, const std::string& channel, PayloadHandler handler)
        : pqxx::notification_receiver(connection, channel), handler_(std::move(handler)) {}
    void operator()(const std::string& payload, int) override { handler_(payload); }

private:
    PayloadHandler handler_;
};

#else

struct Quiet {
    explicit Quiet(pqxx::connection& connection) {
        connection.set_notice_handler([](pqxx::zview) noexcept {});
    }
};

inline pqxx::params params_of(const Statement& statement) {
    pqxx::params values;
    values.reserve(statement.values.size() + 1);
    for (const std::string& value : statement.values) values.append(pqxx::zview(value));
    if (statement.bytes != nullptr) values.append(pqxx::binary_cast(*statement.bytes));
    return values;
}

inline pqxx::result execute(pqxx::nontransaction& on, const Statement& statement) {
    return on.exec(statement.text, params_of(statement));
}

inline pqxx::result execute_prepared(pqxx::nontransaction& on, const Statement& statement) {
    return on.exec(pqxx::prepped(statement.text), params_of(statement));
}

class Subscription {
public:
    Subscription(pqxx::connection& connection, const std::string& channel, PayloadHandler handler)
        : connection_(connection), channel_(channel) {
        connection.listen(channel, [handler = std::move(handler)](const pqxx::notification& notice) {
            handler(std::string(notice.payload));
        });
    }
    ~Subscription() {
        try {
            connection_.listen(channel_);
        } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): a lost connection has no subscription
        }
    }
    Subscription(const Subscription&) = delete;
    Subscription& operator=(const Subscription&) = delete;

private:
    pqxx::connection& connection_;
    std::string channel_;
};

#endif

}  // namespace tunewright::server::postgres
