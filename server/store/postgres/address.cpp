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

std::map<std::string, std::string> options_of(const std::string& uri) {
    const std::unique_ptr<PQconninfoOption, void (*)(PQconninfoOption*)> parsed(PQconninfoParse(uri.c_str(), nullptr),
                                                                                &PQconninfoFree);
    if (!parsed)  // libpq's own message may quote the password
        throw StoreError({StoreFault::Kind::unavailable,
                          "The address of the store cannot be read. It looks like "
                          "postgresql://user:password@host:5432/database; signs such as / @ : # % in user and password "
                          "are written as %2F %40 %3A %23 %25."});
    std::map<std::string, std::string> options;
    for (const PQconninfoOption* option = parsed.get(); option->keyword != nullptr; option++)
        if (option->val != nullptr) options[option->keyword] = option->val;
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
