#include "engine/verify/tolerance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tunewright::verify {
namespace {

struct Tolerance {
    std::string_view figure;
    double relative;
};

// Peaks and margins are stated to 1e-8. A peak is flat: its place is known to the root of that. Times, overshoots and
// single values of a response are stated to 8e-6; both ways together may differ by a little more. Figures of a search
// come from a single coarser run.
constexpr double kPeak = 2e-8, kPlace = 2e-4, kMargin = 2e-8, kOfResponse = 1e-5, kNoise = 2e-4, kSearched = 1e-4;
// |C S| may be largest where the dead time turns L by far more than both grids follow.
constexpr double kTurning = 1e-5;
constexpr std::array<Tolerance, 24> kTolerances = {{
    {"Ms", kPeak},
    {"Mt", kPeak},
    {"Mks", kTurning},
    {"worst_Ms", kPeak},
    {"omega_Ms", kPlace},
    {"omega_Mt", kPlace},
    {"gain_margin", kMargin},
    {"gain_margin_low", kMargin},
    {"phase_margin_deg", kMargin},
    {"delay_margin", kMargin},
    {"extra_dead_time", kMargin},
    {"gain", kMargin},
    {"gain_crossover", kMargin},
    {"phase_crossover", kMargin},
    {"overshoot_percent", kOfResponse},
    {"rise_time", kOfResponse},
    {"rise_time_5_95", kOfResponse},
    {"settling_time", kOfResponse},
    {"first_move", kOfResponse},
    {"peak", kOfResponse},
    {"recovery_time", kOfResponse},
    {"searched_IAE", kSearched},
    {"u_std", kNoise},
    {"noise_gain", kNoise},
}};
constexpr double kSmallestStatedError = 1e-6, kOwnError = 1e-6;
constexpr double kRounding = 1e-12;

}  // namespace

std::optional<double> largest_difference(std::string_view figure, const IndexErrors& stated) {
    const auto of_index = [](const std::optional<double>& error, double promised) {
        return std::max(error.value_or(promised), kSmallestStatedError) + kOwnError;
    };
    if (figure == "IAE") return of_index(stated.IAE, 1e-5);
    if (figure == "ISE") return of_index(stated.ISE, 1e-5);
    if (figure == "ITAE") return of_index(stated.ITAE, 2e-5);
    if (figure == "TV") return of_index(stated.TV, 5e-5);
    const auto found = std::ranges::find(kTolerances, figure, &Tolerance::figure);
    return found == kTolerances.end() ? std::nullopt : std::optional(found->relative);
}

double difference(std::string_view figure, double given, double found) {
    const double distance = std::abs(given - found);
    if (distance == 0) return 0;
    if (figure == "overshoot_percent") return distance / (100 + std::abs(given));
    const double size = std::max(std::abs(given), std::abs(found));
    return size < kRounding ? 0 : distance / size;
}

}  // namespace tunewright::verify
