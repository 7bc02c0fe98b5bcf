#include "server/notify/policy.h"

#include <algorithm>

namespace tunewright::server {
namespace {

constexpr std::size_t kMaxShownLength = 200;

std::string quoted(const std::string& text) {
    return "\"" + text.substr(0, kMaxShownLength) + (text.size() > kMaxShownLength ? "..." : "") + "\"";
}

api::Problem invalid(std::vector<api::FieldError> errors) {
    api::Problem problem{422, "invalid-request", "The request is not valid", errors.front().detail, {}, {}};
    problem.errors = std::move(errors);
    return problem;
}

std::string pointer_of(const std::string& name) {
    std::string pointer = "/" + name;
    std::ranges::replace(pointer, '.', '/');
    return pointer;
}

}  // namespace

NotifyPolicy::NotifyPolicy(const std::vector<std::string>& targets, const std::string& secrets_file)
    : targets_(targets) {
    if (!secrets_file.empty()) secrets_.emplace(secrets_file);
}

std::variant<WebAddress, std::string> NotifyPolicy::address_of(const std::string& url) const {
    auto read = parse_address(url);
    if (const auto* address = std::get_if<WebAddress>(&read); address != nullptr && !targets_.allow(*address))
        return "the operator of this service has not allowed it: give an allowed one, or ask the operator for "
               "--notify-target " +
               address->origin();
    return read;
}

std::vector<std::string> NotifyPolicy::secrets(std::string_view name) {
    return secrets_ ? secrets_->of(name) : std::vector<std::string>();
}

std::optional<api::Problem> NotifyPolicy::refuse(const api::Notify& notify, const std::string& prefix) {
    std::vector<api::FieldError> errors;
    const auto fault = [&](const char* member, const std::string& given, const std::string& why) {
        const std::string name = prefix + member;
        errors.push_back({pointer_of(name), name + " is " + quoted(given) + "; " + why + "."});
    };
    const auto address = address_of(notify.url);
    const bool signs = !secrets("").empty();
    if (const auto* why = std::get_if<std::string>(&address)) {
        fault("url", notify.url, *why);
    } else if (!signs) {
        fault("url", notify.url,
              "this service has no secret for signatures: ask its operator for --notify-secrets FILE, whose lines "
              "`tunewright secret NAME --file FILE` makes, or leave it out and poll the job instead");
    }
    if (signs && !notify.secret_id.empty() && secrets(notify.secret_id).empty())
        fault("secret_id", notify.secret_id,
              "the operator has no secret with that name: give another name, or leave it out for the first");
    if (errors.empty()) return std::nullopt;
    return invalid(std::move(errors));
}

}  // namespace tunewright::server
