// Profiles of the set point or the parameter over time: as a run reads them, and the usual ones across a range.
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

/// Empty, not ascending in t, before t = 0, or not finite.
std::optional<Error> profile_fault(const Profile& profile);

/// Where a run that begins at this value rests: the place itself; along the input the first place with this y.
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
    /// The first point behind t; with `before` the first that is not before it.
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

/// One step from end to end either way, stairs of four steps, and a slow ramp there and back, with times from the rows'
/// slowest integral time and the dead time.
Expected<std::vector<Passage>> standard_passages(const SteadyBranch& branch, const Schedule& schedule);

/// The schedule of one row that is this controller.
Schedule one_row(const IdealPid& controller, double at);

}  // namespace tunewright::range
