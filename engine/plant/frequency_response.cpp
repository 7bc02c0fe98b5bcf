#include "engine/plant/frequency_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "engine/number_text.h"

namespace tunewright {
namespace {

constexpr std::size_t kMinPoints = 8;
constexpr double kPi = std::numbers::pi;
constexpr double kMaxTurn = 2;  // rad between neighbours: beyond it the number of turns is ambiguous

constexpr double kMaxPhaseOffAxis =
    kPi / 3;  // from 0 or 180 degrees: beyond it the sign of the static gain is ambiguous

Error at_field(const std::string& field, const std::string& message, ErrorKind kind = ErrorKind::invalid_argument) {
    return {kind, "plant/" + field, message};
}

std::optional<Error> check_point(const FrequencyResponse& points, std::size_t i) {
    const std::string index = std::to_string(i);
    for (const auto& [name, column] : {std::pair{"omega", &points.omega}, {"re", &points.re}, {"im", &points.im}})
        if (!std::isfinite((*column)[i]))
            return at_field(name + ("/" + index), std::string(name) + " must be a finite number.");
    if (!(points.omega[i] > 0))
        return at_field("omega/" + index, "omega is " + text(points.omega[i]) + "; frequencies must be > 0.");
    if (i > 0 && !(points.omega[i] > points.omega[i - 1]))
        return at_field("omega/" + index, "omega is " + text(points.omega[i]) + " after " + text(points.omega[i - 1]) +
                                              "; the frequencies must be in ascending order, each once. Sort the "
                                              "points.");
    if (points.re[i] == 0 && points.im[i] == 0)
        return at_field("re/" + index, "re and im are both 0 at omega " + text(points.omega[i]) +
                                           "; the response of a plant is not 0. Omit the point.");
    return std::nullopt;
}

}  // namespace

std::optional<Error> points_fault(const FrequencyResponse& points) {
    const std::size_t n = points.omega.size();
    for (const auto& [name, size] : {std::pair{"re", points.re.size()}, {"im", points.im.size()}})
        if (size != n)
            return at_field(name, std::string(name) + " has " + std::to_string(size) + " numbers and omega " +
                                      std::to_string(n) + "; their numbers must be equal.");
    if (n < kMinPoints)
        return at_field("omega", "omega has " + std::to_string(n) + " points; at least " + std::to_string(kMinPoints) +
                                     " are needed.");
    if (points.unstable_poles < 0) return at_field("unstable_poles", "unstable_poles must be >= 0.");
    if (points.integrators < 0) return at_field("integrators", "integrators must be >= 0.");
    for (std::size_t i = 0; i < n; ++i)
        if (auto error = check_point(points, i)) return error;
    return std::nullopt;
}

namespace {

/// Slope of the parabola through three points, at the middle one.
double middle_slope(double x0, double x1, double x2, double y0, double y1, double y2) {
    const double left = (y1 - y0) / (x1 - x0), right = (y2 - y1) / (x2 - x1);
    return (left * (x2 - x1) + right * (x1 - x0)) / (x2 - x0);
}

double slope_at(const std::vector<double>& x, const std::vector<double>& y, std::size_t i) {
    const std::size_t n = x.size();
    if (i > 0 && i + 1 < n) return middle_slope(x[i - 1], x[i], x[i + 1], y[i - 1], y[i], y[i + 1]);
    // At an end, the parabola's slope there: twice the chord's slope minus that at the neighbour.
    const std::size_t a = i == 0 ? 0 : n - 2, inner = i == 0 ? 1 : n - 2;
    return 2 * (y[a + 1] - y[a]) / (x[a + 1] - x[a]) - slope_at(x, y, inner);
}

}  // namespace

Expected<MeasuredPlant> MeasuredPlant::make(const FrequencyResponse& points) {
    if (auto error = points_fault(points)) return *error;
    MeasuredPlant plant;
    plant.unstable_poles_ = points.unstable_poles;
    plant.integrators_ = points.integrators;
    const auto value = [&](std::size_t i) { return std::complex<double>(points.re[i], points.im[i]); };

    // Without its integrators a real plant starts near its positive or its negative static gain.
    const double start = std::remainder(std::arg(value(0)) + 0.5 * kPi * points.integrators, 2 * kPi);
    plant.static_sign_ = std::abs(start) <= 0.5 * kPi ? 1 : -1;
    const double off_axis = plant.static_sign_ > 0 ? std::abs(start) : kPi - std::abs(start);
    if (off_axis > kMaxPhaseOffAxis)
        return at_field("omega/0",
                        "At the lowest frequency, " + text(points.omega[0]) + ", the plant already turns by " +
                            text(off_axis * 180 / kPi) +
                            " degrees, so the sign of its static gain is unknown. Measure lower frequencies, or "
                            "correct the value of integrators.",
                        ErrorKind::unsupported);
    double phase = start - 0.5 * kPi * points.integrators;
    plant.turned_ = -kPi * (std::round(start / kPi) + points.unstable_poles);
    for (std::size_t i = 0; i < points.omega.size(); ++i) {
        const double turn = i == 0 ? 0 : std::arg(value(i) / value(i - 1));
        if (std::abs(turn) > kMaxTurn) break;
        phase += turn;
        plant.omega_.push_back(points.omega[i]);
        plant.log_omega_.push_back(std::log(points.omega[i]));
        plant.log_size_.push_back(std::log(std::abs(value(i))));
        plant.phase_.push_back(phase);
    }
    const std::size_t kept = plant.omega_.size();
    if (kept < points.omega.size() && (kept < kMinPoints || !plant.phase_crossover()))
        return at_field("omega/" + std::to_string(kept),
                        "Between omega " + text(points.omega[kept - 1]) + " and " + text(points.omega[kept]) +
                            " the phase changes by more than 115 degrees, so it is ambiguous. Measure more points "
                            "there.",
                        ErrorKind::unsupported);
    return plant;
}

double MeasuredPlant::interpolate(const std::vector<double>& value, double omega) const {
    const double x = std::clamp(std::log(omega), log_omega_.front(), log_omega_.back());
    const auto above = std::upper_bound(log_omega_.begin() + 1, log_omega_.end() - 1, x);
    const auto i = static_cast<std::size_t>(above - log_omega_.begin()) - 1;
    const double h = log_omega_[i + 1] - log_omega_[i], t = (x - log_omega_[i]) / h;
    const double m0 = h * slope_at(log_omega_, value, i), m1 = h * slope_at(log_omega_, value, i + 1);
    const double rise = value[i + 1] - value[i];
    return value[i] + t * (m0 + t * ((3 * rise - 2 * m0 - m1) + t * (m0 + m1 - 2 * rise)));
}

std::complex<double> MeasuredPlant::at(double omega) const {
    return std::polar(std::exp(interpolate(log_size_, omega)), interpolate(phase_, omega));
}

std::optional<double> MeasuredPlant::phase_crossover() const {
    for (std::size_t i = phase_.size() - 1; i > 0; --i) {
        const double before = phase_[i - 1] + turned_ + kPi, after = phase_[i] + turned_ + kPi;
        if (!(before > 0 && after <= 0)) continue;
        return std::exp(log_omega_[i - 1] + (log_omega_[i] - log_omega_[i - 1]) * before / (before - after));
    }
    return std::nullopt;
}

}  // namespace tunewright
