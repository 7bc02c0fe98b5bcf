#include "server/store/postgres/address.h"

#include <libpq-fe.h>

#include <map>
#include <memory>

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

/// False for what comes of signs in a password that are not written as %XX: parts of it would stand elsewhere.
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
                          "The address of the store cannot be read. It looks like "
                          "postgresql://user:password@host:5432/database; signs such as / @ : ? # % in user and "
                          "password are written as %2F %40 %3A %3F %23 %25."});
    return options;
}

}  // namespace

Address::Address(const std::string& uri) {
    std::map<std::string, std::string> options = options_of(uri);
    const auto value = [&](const char* keyword, const char* otherwise) {
        const auto found = options.find(keyword);
        return found == options.end() ? otherwise : found->second;
    };
    shown_ = "postgresql://" + value("host", "localhost") + ":" + value("port", "5432") + "/" + value("dbname", "");
    options.insert(kDefaults.begin(), kDefaults.end());
    for (const auto& [keyword, text] : options) settings_ += keyword + "=" + quoted(text) + " ";
}

}  // namespace tunewright::server::postgres
