// A rule's settings on problems whose least IAE is bounded from below by a proof (engine/certificate).
//
//   ratio = IAE after a unit load step/proved bound >= 1, wherever the problem's limits on Ms and Mt hold
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/certificate/certificate.h"
#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/progress.h"

namespace tunewright::score {

struct Problem {
    std::string name;
    Plant plant;
    CertifiedStructure structure = CertifiedStructure::pi;
    double Tf = 0;  ///< of pid_fixed
    double Ms = 0, Mt = 0;
    double upper = 0, lower = 0;  ///< IAE of the best known controller, and the proved bound
};

enum class Status {
    kept,           ///< both limits hold
    limits_broken,  ///< Ms or Mt is above the problem's
    unstable,
    no_settings,  ///< the rule has none: `why`
};
/// "kept", "limits-broken", "unstable", "no-settings".
const char* to_string(Status status);

struct ProblemScore {
    std::string name;
    Status status = Status::no_settings;
    double tau = 0;                  ///< L/(L + T) of the plant's first-order reduction; 0 with an integrator
    IdealPid controller;             ///< with the problem's filter
    double Ms = 0, Mt = 0, IAE = 0;  ///< of a stable loop
    double ratio = 0;                ///< of `kept`
    std::string why;
};

/// Performance profile (Dolan and Moré 2002, Mathematical Programming 91, 201-213): the share of all problems that are
/// solved within `ratio`; those with broken limits, without stability or settings never are.
struct ProfilePoint {
    double ratio = 1, share = 0;
};

/// The longest run of problems in ascending order of tau on which the rule has settings that keep all limits.
struct Range {
    double tau_low = 0, tau_high = 0;
    int problems = 0;
    double worst_ratio = 0;
};

struct Score {
    std::vector<ProblemScore> problems;  ///< in the order given
    int kept = 0, limits_broken = 0, unstable = 0, no_settings = 0;
    std::optional<double> median_ratio, worst_ratio;  ///< of the kept ones
    std::vector<ProfilePoint> profile;                ///< a step at each ratio, ascending
    std::optional<Range> range;                       ///< empty: no problem is kept
};

/// Kp, Ti and Td for a problem. The filter of the answer is the problem's own, because the bound is about it.
using SettingsFor = std::function<Expected<IdealPid>(const Problem& problem)>;

/// Errors: cancelled if the control stops it; an invalid_argument of the settings.
Expected<Score> score(const std::vector<Problem>& problems, const SettingsFor& settings, const RunControl& control);

}  // namespace tunewright::score
