#include "server/store/postgres/session.h"

#include <libpq-fe.h>
#include <charconv>
#include <map>
#include <memory>
#include <pqxx/except>
#include <pqxx/nontransaction>

#include "server/store/postgres/text.h"
#include "server/store/store.h"

namespace tunewright::server::postgres {
namespace {

/// In seconds, or milliseconds for tcp_user_timeout.
const std::map<std::string, std::string> kDefaults{
    {"connect_timeout", "5"},    {"keepalives_idle", "10"},     {"keepalives_interval", "5"},
    {"keepalives_count", "3"},   {"tcp_user_timeout", "10000"}, {"application_name", "tunewright"},
    {"client_encoding", "UTF8"},
};

std::string quoted(const std::string& value) {
    std::string text = "'";
    for (const char c : value) {
        if (c == '\'' || c == '\\') text += '\\';
        text += c;
    }
    return text + "'";
}

/// False for an address whose password contains characters that are not written as %XX: parts of it would be read as
/// other fields.
bool makes_sense(const std::map<std::string, std::string>& options) {
    const auto has_any = [&](const char* keyword, const char* signs) {
        const auto found = options.find(keyword);
        return found != options.end() && found->second.find_first_of(signs) != std::string::npos;
    };
    const auto port = options.find("port");
    const bool plain_port = port == options.end() || port->second.find_first_not_of("0123456789,") == std::string::npos;
    return plain_port && !has_any("host", "@") && !has_any("dbname", "@/:");
}

std::map<std::string, std::string> options_of(const std::string& uri) {
    const std::unique_ptr<PQconninfoOption, void (*)(PQconninfoOption*)> parsed(PQconninfoParse(uri.c_str(), nullptr),
                                                                                &PQconninfoFree);
    std::map<std::string, std::string> options;
    for (const PQconninfoOption* option = parsed.get(); option != nullptr && option->keyword != nullptr; option++)
        if (option->val != nullptr) options[option->keyword] = option->val;
    if (!parsed || !makes_sense(options))  // libpq's own message may quote the password
        throw StoreError({StoreFault::Kind::unavailable,
                          "The address of the store cannot be read. Its form is "
                          "postgresql://user:password@host:5432/database; signs such as / @ : ? # % in user and "
                          "password are written as %2F %40 %3A %3F %23 %25."});
    return options;
}

}  // namespace

Address::Address(const std::string& uri, bool pooled) : pooled_(pooled) {
    std::map<std::string, std::string> options = options_of(uri);
    const auto value = [&](const char* keyword, const char* fallback) {
        const auto found = options.find(keyword);
        return found == options.end() ? fallback : found->second;
    };
    shown_ = "postgresql://" + value("host", "localhost") + ":" + value("port", "5432") + "/" + value("dbname", "");
    options.insert(kDefaults.begin(), kDefaults.end());
    for (const auto& [keyword, text] : options) settings_ += keyword + "=" + quoted(text) + " ";
}

namespace {

// A queue's tables grow and shrink faster than the planner's statistics follow: reading by index, row by row, in the
// order in which the statement names the tables, is right at every size.
std::string settings(const std::string& set) {
    std::string text;
    for (const char* setting :
         {"search_path TO tunewright", "statement_timeout TO '10s'", "idle_in_transaction_session_timeout TO '30s'",
          "enable_seqscan TO off", "enable_hashjoin TO off", "enable_mergejoin TO off", "enable_bitmapscan TO off",
          "enable_material TO off", "join_collapse_limit TO 1", "from_collapse_limit TO 1", "jit TO off",
          "synchronous_commit TO on"})
        text.append(set).append(" ").append(setting).append("; ");
    return text;
}

Failure::Kind kind_of(const std::string& state) {
    if (state == "53100") return Failure::Kind::full;
    if (state == "40001" || state == "40P01" || state == "55P03") return Failure::Kind::conflict;
    const std::string kind = state.substr(0, 2);
    // The server ends the connection, or accepts none: shutdown, recovery, too many connections.
    if (state.substr(0, 4) == "57P0" || kind == "08" || state == "53300") return Failure::Kind::broken;
    return Failure::Kind::refused;
}

std::string first_line(std::string text) {
    const std::size_t end = text.find('\n');
    if (end != std::string::npos) text.resize(end);
    return text;
}

}  // namespace

Failure failure_of(const std::exception& error, bool open) {
    const std::string detail = "PostgreSQL: " + first_line(error.what());
    const auto* sql = dynamic_cast<const pqxx::sql_error*>(&error);
    if (sql != nullptr) {
        const Failure::Kind kind = kind_of(sql->sqlstate());
        if (kind != Failure::Kind::refused) return {kind, detail};
    }
    if (!open || dynamic_cast<const pqxx::broken_connection*>(&error) != nullptr)
        return {Failure::Kind::broken, detail};
    if (dynamic_cast<const pqxx::disk_full*>(&error) != nullptr) return {Failure::Kind::full, detail};
    if (dynamic_cast<const pqxx::transaction_rollback*>(&error) != nullptr) return {Failure::Kind::conflict, detail};
    return {Failure::Kind::refused, detail};
}

std::string literal(std::string_view text) {
    std::string quoted = "'";
    for (const char c : to_column(text)) {
        if (c == '\'') quoted += c;
        quoted += c;
    }
    return quoted + "'";
}

std::unique_ptr<Link> connect(const Address& address) {
    try {
        auto link = std::make_unique<Link>(address);
        if (!address.pooled()) pqxx::nontransaction(link->connection).exec(settings("SET"));
        return link;
    } catch (const std::exception& error) {
        throw Failure(Failure::Kind::broken, "PostgreSQL: " + first_line(error.what()));
    }
}

Values& Values::text(std::string_view value) { return plain(to_column(value)); }

Values& Values::plain(std::string value) {
    list.push_back(std::move(value));
    return *this;
}

Values& Values::real(double value) {
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    return plain(error == std::errc{} ? std::string(digits, end) : "NaN");
}

Session::Session(const Address& address, std::shared_ptr<Line> line)
    : pooled_(address.pooled()), link_(connect(address)), line_(std::move(line)) {}
Session::~Session() = default;

/// Runs `work`, which calls the server: the line is watched meanwhile, and an exception becomes a Failure.
template <class Work>
auto Session::watched(Work work) {
    if (line_) line_->asked(link_->connection.sock());
    const std::shared_ptr<void> answered(nullptr, [this](void*) {
        if (line_) line_->answered();
    });
    try {
        return work();
    } catch (const std::exception& error) {
        throw failure_of(error, link_->connection.is_open());
    }
}

template <class Work>
pqxx::result Session::guarded(Work work) {
    return watched([&] {
        pqxx::nontransaction on(link_->connection);
        return work(on);
    });
}

/// Version 6 of the library prepares the statement at its first use, version 7 at once.
const std::string& Session::prepared(const std::string& sql) {
    const auto found = names_.find(sql);
    if (found != names_.end()) return found->second;
    const std::string name = "s" + std::to_string(names_.size());
    watched([&] { link_->connection.prepare(name, sql); });
    return names_.emplace(sql, name).first->second;
}

template <class Work>
pqxx::result Session::sent(Work work) {
    if (!pooled_ || open_) return guarded(work);
    begin();
    try {
        pqxx::result found = guarded(work);
        commit();
        return found;
    } catch (const Failure& failure) {
        if (failure.kind != Failure::Kind::broken) rollback();
        throw;
    }
}

pqxx::result Session::run(const std::string& sql, const Values& values, const std::string* bytes) {
    if (pooled_) return sent([&](pqxx::nontransaction& on) { return execute(on, {sql, values.list, bytes}); });
    const std::string& name = prepared(sql);
    return sent([&](pqxx::nontransaction& on) { return execute_prepared(on, {name, values.list, bytes}); });
}

pqxx::result Session::run_plain(const std::string& sql) {
    return sent([&](pqxx::nontransaction& on) { return on.exec(sql); });
}

std::int64_t Session::begin(bool durable) {
    std::string manner = pooled_ ? settings("SET LOCAL") : "";
    if (!durable) manner += "SET LOCAL synchronous_commit TO off; ";
    const std::string sql = "BEGIN; " + manner + "SELECT txid_current()";
    const pqxx::result rows = guarded([&](pqxx::nontransaction& on) { return on.exec(sql); });
    open_ = true;
    return rows[0][0].as<std::int64_t>();
}

void Session::commit(const std::string& last) {
    guarded([&](pqxx::nontransaction& on) { return on.exec(last + "COMMIT"); });
    open_ = false;
}

void Session::rollback() {
    open_ = false;
    guarded([](pqxx::nontransaction& on) { return on.exec("ROLLBACK"); });
}

}  // namespace tunewright::server::postgres
