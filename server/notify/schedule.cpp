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
constexpr seconds kMostAskedFor = std::chrono::hours(1);

}  // namespace

std::optional<milliseconds> pause_after(const FailedTry& failed) {
    const milliseconds left(failed.end + milliseconds(kTellingTime).count() - failed.now);
    if (left.count() <= 0) return std::nullopt;
    const auto number = static_cast<std::size_t>(std::clamp<int>(failed.earlier, 0, kPauses.size() - 1));
    const double factor = 1 + kJitter * (2 * failed.chance - 1);
    milliseconds pause(std::llround(static_cast<double>(milliseconds(kPauses[number]).count()) * factor));
    if (failed.retry_after) pause = std::max<milliseconds>(pause, std::min(*failed.retry_after, kMostAskedFor));
    return std::min(pause, left);
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
