// Times of the attempts of a notification, and its end.
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "server/clock.h"

namespace tunewright::server {

/// A failed attempt.
struct FailedTry {
    int earlier = 0;                                       ///< failed attempts before it
    UnixMs end = 0;                                        ///< of the job or batch
    UnixMs now = 0;                                        ///< time of the failure
    double chance = 0.5;                                   ///< random, from 0 to 1, for the jitter
    std::optional<std::chrono::seconds> retry_after = {};  ///< as the receiver asked
};

/// The time after the end in which delivery is attempted.
constexpr std::chrono::hours kMaxDeliveryTime{24};

/// The pause until the next attempt: 5 s, 5 min, 30 min, 2 h, 5 h, then 10 h each, 10 % more or less, so that attempts
/// which failed together are not repeated together; longer if the receiver asks for it, up to an hour. The last attempt
/// is made when the time is over. Empty after that: the notification is given up.
std::optional<std::chrono::milliseconds> pause_after(const FailedTry& failed);

/// The pause of a notification that this process may not send: an eighth of the time since the end, 10 % more or less,
/// and at least `min`, so that a process which may send it finds it soon; at most 5 min, so that it is found when
/// settings change. Empty when the time is over.
std::optional<std::chrono::milliseconds> pause_for_others(const FailedTry& left, std::chrono::milliseconds min);

/// Parses the field Retry-After: seconds, or a date (RFC 9110, 10.2.3); empty if it is neither.
std::optional<std::chrono::seconds> read_retry_after(std::string_view field, UnixMs now);

}  // namespace tunewright::server
