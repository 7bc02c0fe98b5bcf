// The operator's policy for notifications: allowed targets, and secrets for signatures.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/contract/terms.h"
#include "server/notify/secrets.h"
#include "server/notify/target.h"

namespace tunewright::server {

class NotifyPolicy {
public:
    /// `secrets_file` may be "". Throws std::invalid_argument with a sentence if a target or the file cannot be used.
    NotifyPolicy(const std::vector<std::string>& targets, const std::string& secrets_file);

    /// 422 for a notification that is not allowed, with every fault and its cure. `prefix` precedes url and secret_id
    /// in the caller's notation: "notify." in a request, "notify_" in parameters.
    std::optional<api::Problem> refuse(const api::Notify& notify, const std::string& prefix);

    /// The address, if it is allowed now; else the reason, as the end of a sentence.
    std::variant<WebAddress, std::string> address_of(const std::string& url) const;
    /// Empty if no secret has that name now.
    std::vector<std::string> secrets(std::string_view name);
    /// False if no target is allowed.
    bool allows_any() const { return !targets_.empty(); }

private:
    Targets targets_;
    std::optional<Secrets> secrets_;
};

}  // namespace tunewright::server
