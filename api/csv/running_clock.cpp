#include "api/csv/running_clock.h"

#include <chrono>
#include <cmath>

namespace tunewright::api {
namespace {

constexpr double kMaxRepeated = 120;          // seconds of the hour that may be missing when the clock goes back
constexpr double kLongestStep = 1200;         // between rows, to distinguish a missing hour from a pause
constexpr double kMaxHourErrorInSteps = 0.5;  // tolerance of the hour, in steps
constexpr int kFirstHour = 1, kLastHour = 3;  // the hours of the day at which some country changes its clock

/// True on a Sunday of March, April, September or October: every country that changes its clock does so on one.
bool may_begin_summer_time(double seconds) {
    const std::chrono::sys_days day(std::chrono::days(static_cast<long>(std::floor(seconds / kDay))));
    const auto month = static_cast<unsigned>(std::chrono::year_month_day(day).month());
    return std::chrono::weekday(day) == std::chrono::Sunday && (month == 3 || month == 4 || month == 9 || month == 10);
}

}  // namespace

bool RunningClock::leaves_out_an_hour(const TimeStamp& stamp, double ahead) const {
    if (!stamp.has_date || stamp.has_zone || !(step_ > 0) || step_ > kLongestStep) return false;
    if (std::abs(ahead - kHour - step_) > kMaxHourErrorInSteps * step_ || !may_begin_summer_time(stamp.seconds))
        return false;
    const double now = std::fmod(stamp.seconds, kDay), before = now - ahead;
    for (int hour = kFirstHour; hour <= kLastHour; ++hour)
        if (before < hour * kHour && now >= (hour + 1) * kHour) return true;
    return false;
}

double RunningClock::seconds(const TimeStamp& stamp, int line) {
    double seconds = stamp.seconds + moved_;
    const auto move = [&](double by) {
        moved_ += by;
        seconds += by;
    };
    if (last_ && seconds < *last_) {
        const double back = *last_ - seconds;
        if (stamp.minutes && back > kHour / 2) {
            move(kHour);
        } else if (!stamp.has_date && back > kDay / 2) {
            move(kDay);
        } else if (!stamp.has_zone && back <= kHour && back > kHour - kMaxRepeated) {
            move(kHour);
            notes_.push_back("The clock goes back by an hour at line " + std::to_string(line) +
                             ", as at the end of summer time; the times continue without the jump.");
        }
    } else if (last_ && leaves_out_an_hour(stamp, seconds - *last_)) {
        move(-kHour);
        notes_.push_back("The clock goes forward by an hour at line " + std::to_string(line) +
                         ", as at the start of summer time; the times continue without that hour.");
    }
    if (last_) step_ = seconds - *last_;
    last_ = seconds;
    return seconds;
}

}  // namespace tunewright::api
