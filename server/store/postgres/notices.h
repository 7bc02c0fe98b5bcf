// Notices between replicas: small payloads on one channel, "TAG KIND ID ID ...", sent with the commit.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "server/store/store.h"

namespace tunewright::server::postgres {

constexpr const char* kChannel = "tunewright";

/// The notices of one transaction.
class Notices {
public:
    void queued() { queued_ = true; }
    void progress(const std::string& id) { progress_.push_back(id); }
    /// "" if many have ended.
    void ended(const std::string& id) { ended_.push_back(id); }
    void cancel(const std::string& id) { cancel_.push_back(id); }

    /// The statements that send the notices, "" for none. `tag` names the process.
    std::string statements(const std::string& tag) const;

private:
    bool queued_ = false;
    std::vector<std::string> progress_, ended_, cancel_;
};

/// Calls `listener` for each notice in a payload of another process.
void read_payload(std::string_view payload, std::string_view own_tag,
                  const std::function<void(const StoreNotice&)>& listener);

}  // namespace tunewright::server::postgres
