// The terms on which a job is run, beside what it computes: whom to tell of its end, when its turn comes, and whether
// an earlier job will do. They change no figure, so they are no part of the hash that names a request.
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

/// Whom to tell when a job or a batch has ended. What a url may be is the operator's business.
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

/// The members of Terms, for JobRequest and RangeRequest.
template <class Request>
void add_terms(Description<Request>& description);

/// 422 for a job that is to wait longer for its time than the contract allows.
std::optional<Problem> refuse_far(const std::optional<std::int64_t>& not_before);

/// What the text of a batch's `notify` says; 422 with pointers below /notify.
std::variant<Notify, Problem> read_notify(std::string_view json);

/// Takes the terms out of a request, of which what is computed is left.
void leave_out_terms(nlohmann::ordered_json& request);

/// 422 for a request that carries terms which an entry of a batch cannot have of its own.
std::optional<Problem> refuse_terms_of_entry(const nlohmann::ordered_json& request);

}  // namespace tunewright::api
