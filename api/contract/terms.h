// The terms on which a job is run, beside what it computes: whom to tell of its end, when its turn comes, and whether
// an earlier job will do. They change no figure, so they are no part of the hash that names a request.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "api/problem.h"

namespace tunewright::api {

template <class T>
class Description;
template <class T>
struct Codec;

constexpr std::size_t kMaxNameLength = 200;  ///< bytes of the name of a job or a batch
constexpr int kMaxDaysAhead = 30;            ///< that a job may wait for its time

/// Whom to tell when a job or a batch has ended. What a url may be is the operator's business.
struct Notify {
    std::string url;
    std::string secret_id;  ///< "": the operator's first secret
};

const Description<Notify>& notify_contract();

/// A date and a time of day with its zone, ISO 8601, as milliseconds since 1970, UTC. Of requests alone.
Codec<std::int64_t> moment();
/// 422 for a job that is to wait until more than kMaxDaysAhead from now.
std::optional<Problem> refuse_far(const std::optional<std::int64_t>& not_before);

constexpr const char* kNotBeforeSentence =
    "The job starts at this time or later; a time in the past means at once. ISO 8601 with a zone, such as "
    "2026-05-04T06:00:00Z; at most 30 days ahead.";
constexpr const char* kUniqueSentence =
    "true: if a job of this very request waits, runs or has succeeded and is kept, the answer is that job and no "
    "second "
    "one is made. Name, timeout_s and every other member count; notify, priority, not_before and unique do not.";

/// What the text of a batch's `notify` says; 422 with pointers below /notify.
std::variant<Notify, Problem> read_notify(std::string_view json);

/// Takes the terms out of a request, of which what is computed is left.
void leave_out_terms(nlohmann::ordered_json& request);

/// 422 for a request that carries terms which an entry of a batch cannot have of its own.
std::optional<Problem> refuse_terms_of_entry(const nlohmann::ordered_json& request);

}  // namespace tunewright::api
