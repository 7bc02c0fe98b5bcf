// When somebody who could not be told is tried again, and when he is given up.
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "server/clock.h"

namespace tunewright::server {

/// A try that has failed.
struct FailedTry {
    int earlier = 0;                                       ///< tries that failed before it
    UnixMs end = 0;                                        ///< of the job or batch
    UnixMs now = 0;                                        ///< when it failed
    double chance = 0.5;                                   ///< from 0 to 1, for the jitter
    std::optional<std::chrono::seconds> retry_after = {};  ///< what the receiver asked for
};

/// How long after the end somebody is tried.
constexpr std::chrono::hours kTellingTime{24};

/// The pause until the next try: 5 s, 5 min, 30 min, 2 h, 5 h, then 10 h each, 10 % more or less, so that those who
/// failed together do not come back together; longer where the receiver asks for it, up to an hour. The last try comes
/// when the time is over. Nothing after that: he is given up.
std::optional<std::chrono::milliseconds> pause_after(const FailedTry& failed);

/// The pause of a note that this process may not send: an eighth of the time since the end, 10 % more or less, and not
/// below `min`, so that whoever may send it finds it soon; at most 5 min, so that it is found when settings change.
/// Nothing when the time is over.
std::optional<std::chrono::milliseconds> pause_for_others(const FailedTry& left, std::chrono::milliseconds min);

/// What the field Retry-After says: seconds, or a moment (RFC 9110, 10.2.3); nothing where it says neither.
std::optional<std::chrono::seconds> read_retry_after(std::string_view field, UnixMs now);

}  // namespace tunewright::server
