#include "engine/tuning/device/typed_grid.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "engine/controller/product/to_controller.h"

namespace tunewright::device {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMinCoarseStep = 0.004;     // of a value: with larger steps the neighbours are tried too
constexpr int kMaxExtraSteps = 2;            // additional steps beyond floor and ceiling, if they are coarse
constexpr int kMaxGainSteps = 6;             // steps of the gain that are tried below the first feasible one
constexpr double kLongestClimb = 64;         // steps of the gain
constexpr double kMaxClimbCostRatio = 1.25;  // multiple of the IAE: more than a climb can be expected to save
constexpr double kProbeFactor = 1.01;        // factor of a number that shows the direction of its effect
constexpr int kTypedDigits = 4;              // digits of a number without its own resolution

/// One number that can be entered.
struct Number {
    std::size_t at = 0;  // index in the settings
    product::ParameterRole role = product::ParameterRole::gain;
    std::vector<double> values;  // for the gain: from the strongest to the weakest loop
};

/// The step in which a value of this size can be entered.
double step_of(const product::Tunable& tunable, double value) {
    if (tunable.resolution > 0) return tunable.resolution;
    if (value == 0) return 0;
    return std::pow(10.0, std::floor(std::log10(std::abs(value))) - (kTypedDigits - 1));
}

std::vector<double> neighbours(const product::Tunable& tunable, double value) {
    const double step = step_of(tunable, value);
    if (step == 0) return {value};
    const bool coarse = step > kMinCoarseStep * std::abs(value);
    const double below = std::floor(value / step);
    const int more = coarse ? kMaxExtraSteps : 0;
    std::vector<double> values;
    for (int i = -more; i <= 1 + more; ++i) {
        const double candidate = (below + i) * step;
        if (candidate >= tunable.range.low && candidate <= tunable.range.high && (candidate > 0) == (value > 0))
            values.push_back(candidate);
    }
    if (values.empty()) values.push_back(std::clamp(value, tunable.range.low, tunable.range.high));
    return values;
}

/// True if a larger number makes a weaker controller: a proportional band.
bool weakens(const DeviceModel& device, product::Settings settings, std::size_t at) {
    double& value = std::get<double>(settings[at].value);
    std::vector<product::Note> notes;
    const auto before = product::to_controller(*device.product, settings, device.context, notes);
    value *= kProbeFactor;
    const auto after = product::to_controller(*device.product, settings, device.context, notes);
    return before && after && std::abs(after->Kp) < std::abs(before->Kp);
}

class Grid {
public:
    Grid(const DeviceModel& device, const std::vector<const LinearPlant*>& plants, const PeakLimits& limits,
         Fitted near, double enough)
        : device_(device), plants_(plants), limits_(limits), near_(std::move(near)), min_(enough) {
        for (const product::Tunable& tunable : product::tunable_parameters(*device.product)) {
            for (std::size_t i = 0; i < near_.settings.size(); ++i) {
                const auto* value = std::get_if<double>(&near_.settings[i].value);
                if (near_.settings[i].name != tunable.name || value == nullptr || *value == 0) continue;
                // The number of samples has already been chosen, and the other settings for it.
                if (tunable.role == product::ParameterRole::filter &&
                    product::parameter_named(*device_.product, tunable.name)->shape == product::Shape::slope_samples &&
                    device_.sampled())
                    continue;
                numbers_.push_back({i, tunable.role, neighbours(tunable, *value)});
                if (tunable.role == product::ParameterRole::gain) gain_step_ = step_of(tunable, *value);
            }
        }
    }

    std::optional<Fitted> best(const RunControl& control);

private:
    void look(product::Settings settings, std::size_t number);
    void look_at_gains(product::Settings settings, const Number& gain);
    void climb(product::Settings& settings, std::size_t gain, double step) const;
    double min_possible(const product::Settings& settings) const;
    std::optional<Fitted> held(const product::Settings& settings) const;
    bool consider(const product::Settings& settings);

    const DeviceModel& device_;
    const std::vector<const LinearPlant*>& plants_;
    const PeakLimits& limits_;
    Fitted near_;
    std::vector<Number> numbers_;
    double gain_step_ = 0;
    std::optional<Fitted> best_;
    double min_;
};

// |integral of y| after a unit load: Ti/|Kp|.
double Grid::min_possible(const product::Settings& settings) const {
    std::vector<product::Note> notes;
    const auto pid = product::to_controller(*device_.product, settings, device_.context, notes);
    return pid ? pid->Ti / std::abs(pid->Kp) : kInfinity;
}

std::optional<Fitted> Grid::held(const product::Settings& settings) const {
    auto fitted = fit(device_, settings);
    if (!fitted) return std::nullopt;
    for (const LinearPlant* plant : plants_)
        if (excess_on(*plant, fitted->law, limits_) > limits::kMaxRelativeExcessSearched) return std::nullopt;
    return std::move(*fitted);
}

// True if the limits hold.
bool Grid::consider(const product::Settings& settings) {
    auto fitted = held(settings);
    if (!fitted) return false;
    const double IAE = load_iae_of(*plants_.front(), fitted->law);
    if (IAE < min_) {
        min_ = IAE;
        best_ = std::move(*fitted);
    }
    return true;
}

// From the strongest gain down to the first that keeps the limits; if the strongest does, further up as long as they
// hold, because numbers other than the design's may allow more.
void Grid::look_at_gains(product::Settings settings, const Number& gain) {
    double& value = std::get<double>(settings[gain.at].value);
    const double first = value;
    std::vector<double> values = gain.values;
    // A larger proportional band is a smaller gain.
    const bool band = weakens(device_, settings, gain.at);
    const double stronger = (band ? -gain_step_ : gain_step_) * (first < 0 ? -1 : 1);
    std::sort(values.begin(), values.end(),
              [&](double a, double b) { return band ? std::abs(a) < std::abs(b) : std::abs(a) > std::abs(b); });
    for (int i = 0; i < kMaxGainSteps; ++i) {
        const double next = values.back() - stronger;
        if ((next > 0) == (first > 0)) values.push_back(next);
    }
    for (const double candidate : values) {
        value = candidate;
        if (!(min_possible(settings) < min_ * (candidate == values.front() ? kMaxClimbCostRatio : 1))) return;
        if (!held(settings)) continue;
        if (candidate == values.front()) climb(settings, gain.at, stronger);
        consider(settings);
        return;
    }
}

void Grid::climb(product::Settings& settings, std::size_t gain, double step) const {
    double& value = std::get<double>(settings[gain].value);
    const auto moved = [&](double by) {
        const double from = value;
        value += by;
        if ((value > 0) == (from > 0) && held(settings)) return true;
        value = from;
        return false;
    };
    double width = 1;
    while (width < kLongestClimb && moved(width * step)) width *= 2;
    for (width /= 2; width >= 1; width /= 2) moved(width * step);
}

void Grid::look(product::Settings settings, std::size_t number) {
    while (number < numbers_.size() && numbers_[number].role == product::ParameterRole::gain) ++number;
    if (number == numbers_.size()) {
        const auto gain = std::find_if(numbers_.begin(), numbers_.end(),
                                       [](const Number& n) { return n.role == product::ParameterRole::gain; });
        if (gain == numbers_.end())
            consider(settings);
        else
            look_at_gains(std::move(settings), *gain);
        return;
    }
    for (const double value : numbers_[number].values) {
        settings[numbers_[number].at].value = value;
        look(settings, number + 1);
    }
}

std::optional<Fitted> Grid::best(const RunControl& control) {
    if (!control.stop.stop_requested()) look(near_.settings, 0);
    if (!best_) return std::nullopt;
    best_->settings = near_.settings;
    best_->notes = near_.notes;
    return std::move(best_);
}

}  // namespace

double number_of(const std::string& text, double fallback) {
    double value = fallback;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? value : fallback;
}

Expected<Fitted> on_grid(const DeviceModel& device, const std::vector<const LinearPlant*>& plants,
                         const PeakLimits& limits, Fitted near, double enough, const RunControl& control) {
    if (auto best = Grid(device, plants, limits, std::move(near), enough).best(control)) return std::move(*best);
    if (control.stop.stop_requested()) return Error{ErrorKind::cancelled, "", "The job was cancelled."};
    return Error{ErrorKind::no_feasible_controller, "",
                 "No settings near the optimum that this controller accepts keep the limits: its steps are too coarse "
                 "for this loop. Raise the limit on Ms slightly, or use a controller with finer settings."};
}

}  // namespace tunewright::device
