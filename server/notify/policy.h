// What the operator allows in telling others: where to, and signed by what.
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
    /// `secrets_file` may be "". Throws std::invalid_argument with a sentence where one of them cannot be used.
    NotifyPolicy(const std::vector<std::string>& targets, const std::string& secrets_file);

    /// 422 where this may not be accepted, with every fault and its cure. `prefix` is what stands before url and
    /// secret_id where the caller writes them: "notify." in a request, "notify_" in parameters.
    std::optional<api::Problem> refuse(const api::Notify& notify, const std::string& prefix);

    /// The address, where it is allowed now; else why it is not, as the end of a sentence.
    std::variant<WebAddress, std::string> address_of(const std::string& url) const;
    /// None where no secret has that name now.
    std::vector<std::string> secrets(std::string_view name);
    /// False where nobody may be told.
    bool allows_any() const { return !targets_.empty(); }

private:
    Targets targets_;
    std::optional<Secrets> secrets_;
};

}  // namespace tunewright::server
