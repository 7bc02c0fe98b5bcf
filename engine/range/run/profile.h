// Profiles of the set point or the parameter over time for a run, and the usual ones across a range.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/controller/schedule/schedule.h"
#include "engine/error.h"
#include "engine/expected.h"
#include "engine/range/run/scheduled_run.h"

namespace tunewright::range {

/// Error if it is empty, not ascending in t, begins before t = 0, or is not finite.
std::optional<Error> profile_fault(const Profile& profile);

/// The steady state with this initial value: that of the value itself; along the input the first one with this y.
Expected<SteadyState> rest_at(const SteadyBranch& branch, double value);

/// The profile's value just after (or before) a time, and its slope there.
class ProfileReader {
public:
    explicit ProfileReader(const Profile& profile) : profile_(profile) {}

    double at(double t, bool before) const {
        const std::size_t k = after(t, before);
        if (k == 0) return profile_.front().value;
        if (k == profile_.size()) return profile_.back().value;
        const auto &a = profile_[k - 1], &b = profile_[k];
        return a.value + (b.value - a.value) * (t - a.t) / (b.t - a.t);
    }
    double slope(double t, bool before) const {
        const std::size_t k = after(t, before);
        if (k == 0 || k == profile_.size()) return 0;
        const auto &a = profile_[k - 1], &b = profile_[k];
        return (b.value - a.value) / (b.t - a.t);
    }
    double size() const {
        const auto [low, high] = std::ranges::minmax(profile_, {}, &ProfilePoint::value);
        return high.value - low.value;
    }

private:
    /// The first point after t; with `before` the first that is not before t.
    std::size_t after(double t, bool before) const {
        const auto it = before ? std::ranges::lower_bound(profile_, t, {}, &ProfilePoint::t)
                               : std::ranges::upper_bound(profile_, t, {}, &ProfilePoint::t);
        return std::size_t(it - profile_.begin());
    }

    const Profile& profile_;
};

/// A named passage over the whole range.
struct Passage {
    std::string name;  ///< "step up", "step down", "stairs", "ramp"
    Profile profile;
    double horizon = 0;
};

/// One step from end to end in each direction, stairs of four steps, and a slow ramp up and down. The times depend on
/// the rows' slowest integral time and on the dead time.
Expected<std::vector<Passage>> standard_passages(const SteadyBranch& branch, const Schedule& schedule);

/// The schedule with this controller as its only row.
Schedule one_row(const IdealPid& controller, double at);

}  // namespace tunewright::range
