// The terms on which a job is run, other than its computation: the webhook at its end, its start time, and whether an
// earlier job of the same request may answer. They change no figure, so they are not part of the hash that identifies a
// request.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "api/json/problem.h"

namespace tunewright::api {

template <class T>
class Description;

constexpr std::size_t kMaxNameLength = 200;  ///< bytes of the name of a job or a batch

/// The webhook that is called when a job or a batch has ended. The operator decides which URLs are allowed.
struct Notify {
    std::string url;
    std::string secret_id;  ///< "": the operator's first secret
};

const Description<Notify>& notify_contract();

/// The part of a request that every job has.
struct JobTerms {
    double timeout_s = 60;
    std::optional<Notify> notify;
    bool low_priority = false;
    std::optional<std::int64_t> not_before;  ///< ms since 1970, UTC
    bool unique = false;
};

/// The terms, for each type of request that may be a job.
template <class Request>
void add_terms(Description<Request>& description);

/// 422 for a job whose start time is later than the contract allows.
std::optional<Problem> refuse_far(const std::optional<std::int64_t>& not_before);

/// Parses the `notify` of a batch; 422 with pointers below /notify.
std::variant<Notify, Problem> read_notify(std::string_view json);

/// Removes the terms from a request, which leaves the members that are computed.
void leave_out_terms(nlohmann::ordered_json& request);

/// 422 for a request with terms that only a whole batch can have.
std::optional<Problem> refuse_terms_of_entry(const nlohmann::ordered_json& request);

}  // namespace tunewright::api
