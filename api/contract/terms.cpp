#include "api/contract/terms.h"

#include "api/describe/body.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxUrl = 2000;
constexpr std::size_t kMaxSecretName = 64;

}  // namespace

const Description<Notify>& notify_contract() {
    static const auto description = [] {
        Description<Notify> d("Notify",
                              "Whom to tell when it has ended: a POST to that address, signed as Standard Webhooks has "
                              "it, tried again for a day until it is answered with a status from 200 to 299.");
        d.field("url", &Notify::url, text(kMaxUrl), "The address; the operator of the service has to have allowed it.",
                {.required = true})
            .field("secret_id", &Notify::secret_id, text(kMaxSecretName),
                   "The name of the operator's secret that signs it. Without a name it is the first.",
                   {.no_default = true})
            .example({{"url", "https://hooks.example.com/tunewright"}, {"secret_id", "line-1"}});
        return d;
    }();
    return description;
}

std::variant<Notify, Problem> read_notify(std::string_view json) {
    auto parsed = parse(json);
    if (const auto* problem = std::get_if<Problem>(&parsed)) return *problem;
    Notify notify;
    Reader reader;
    {
        const Reader::At at(reader, "notify");
        notify_contract().read(std::get<Json>(parsed), notify, reader);
    }
    if (auto problem = reader.problem()) return *std::move(problem);
    return notify;
}

void leave_out_terms(Json& request) {
    request.erase("notify");
    request.erase("priority");
}

std::optional<Problem> refuse_terms_of_entry(const Json& request) {
    if (!request.is_object()) return std::nullopt;
    Reader reader;
    if (request.contains("notify"))
        reader.fault_at("notify",
                        "notify stands in an entry, but a batch is told as a whole: put notify beside jobs, or into "
                        "the parameter notify_url.");
    if (const auto at = request.find("priority"); at != request.end() && *at == "normal")
        reader.fault_at("priority",
                        "priority is \"normal\", which no entry of a batch has: leave it out, or post the job alone.");
    return reader.problem();
}

}  // namespace tunewright::api
