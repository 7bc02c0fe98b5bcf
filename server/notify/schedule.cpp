#include "server/notify/schedule.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <ctime>
#include <string>

namespace tunewright::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::array<seconds, 6> kPauses{seconds(5),
                                         std::chrono::minutes(5),
                                         std::chrono::minutes(30),
                                         std::chrono::hours(2),
                                         std::chrono::hours(5),
                                         std::chrono::hours(10)};
constexpr double kJitter = 0.1;
constexpr int kShareOfAge = 8;  // of the age of a notification that is left to other processes
constexpr seconds kMaxRetryAfter = std::chrono::hours(1);

milliseconds jittered(milliseconds pause, double chance) {
    return milliseconds(std::llround(static_cast<double>(pause.count()) * (1 + kJitter * (2 * chance - 1))));
}

/// The last attempt is made when the time is over.
std::optional<milliseconds> within_time(const FailedTry& failed, milliseconds pause) {
    const milliseconds left(failed.end + milliseconds(kMaxDeliveryTime).count() - failed.now);
    if (left.count() <= 0) return std::nullopt;
    return std::min(pause, left);
}

}  // namespace

std::optional<milliseconds> pause_after(const FailedTry& failed) {
    const auto number = static_cast<std::size_t>(std::clamp<int>(failed.earlier, 0, kPauses.size() - 1));
    milliseconds pause = jittered(kPauses[number], failed.chance);
    if (failed.retry_after) pause = std::max<milliseconds>(pause, std::min(*failed.retry_after, kMaxRetryAfter));
    return within_time(failed, pause);
}

std::optional<milliseconds> pause_for_others(const FailedTry& left, milliseconds min) {
    const milliseconds age(left.now - left.end);
    const auto pause = std::clamp<milliseconds>(age / kShareOfAge, min, kPauses[1]);
    return within_time(left, jittered(pause, left.chance));
}

std::optional<seconds> read_retry_after(std::string_view field, UnixMs now) {
    std::int64_t count = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), count);
    if (error == std::errc{} && end == field.data() + field.size() && count >= 0)
        return seconds(std::min<std::int64_t>(count, std::int64_t{1} << 31));
    std::tm moment{};
    const std::string text(field);
    const char* rest = ::strptime(text.c_str(), "%a, %d %b %Y %H:%M:%S GMT", &moment);
    if (rest == nullptr || *rest != '\0') return std::nullopt;
    return seconds(std::max<std::int64_t>(0, ::timegm(&moment) - now / 1000));
}

}  // namespace tunewright::server
