#include "server/store/postgres/notices.h"

#include "server/store/postgres/session.h"
#include "server/store/postgres/text.h"

namespace tunewright::server::postgres {
namespace {

constexpr std::size_t kMaxPayloadLength = 7000;  // PostgreSQL's own limit is 8000 bytes

std::string notify(const std::string& payload) {
    return std::string("SELECT pg_notify('") + kChannel + "', " + literal(payload) + "); ";
}

std::string statements_of(const std::string& head, const std::vector<std::string>& ids) {
    std::string statements;
    std::string payload = head;
    for (const std::string& id : ids) {
        if (payload.size() + id.size() > kMaxPayloadLength) {
            statements += notify(payload);
            payload = head;
        }
        payload += " " + id;
    }
    return payload == head ? statements : statements + notify(payload);
}

std::string_view next_word(std::string_view& text) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return word;
}

}  // namespace

std::string Notices::statements(const std::string& tag) const {
    return (queued_ ? notify(tag + " q") : "") + statements_of(tag + " p", progress_) +
           statements_of(tag + " e", ended_) + statements_of(tag + " c", cancel_);
}

void read_payload(std::string_view payload, std::string_view own_tag,
                  const std::function<void(const StoreNotice&)>& listener) {
    if (next_word(payload) == own_tag) return;
    const std::string_view kind = next_word(payload);
    if (kind == "q") return listener({StoreNotice::Kind::queued, ""});
    StoreNotice notice;
    notice.kind = kind == "p"   ? StoreNotice::Kind::progress
                  : kind == "c" ? StoreNotice::Kind::cancel
                                : StoreNotice::Kind::ended;
    do {
        notice.id = from_column(next_word(payload));
        listener(notice);
    } while (!payload.empty());
}

}  // namespace tunewright::server::postgres
