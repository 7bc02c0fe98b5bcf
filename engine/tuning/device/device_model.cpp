#include "engine/tuning/device/device_model.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/controller/product/formula.h"
#include "engine/controller/product/notes.h"
#include "engine/controller/product/to_controller.h"
#include "engine/loop/sampled/held_plant.h"
#include "engine/number_text.h"
#include "engine/tuning/device/typed_grid.h"
#include "engine/tuning/device/typed_ranges.h"

namespace tunewright::device {
namespace {

// Shares of M - 1 that are reserved for the rounding of settings: the smallest one is used with which rounded settings
// keep the limits.
constexpr double kMargins[] = {0, 0.0005, 0.001, 0.002, 0.004, 0.015, 0.05};
constexpr double kMinCoarseStep = 0.01;    // step relative to the number: numbers with smaller steps are simply rounded
constexpr double kCostOfMargin = 2;        // of ln IAE, per share of M - 1
constexpr int kMaxFilterSampleOffset = 2;  // of a filter: from the number of samples that its rule gives
constexpr double kEqualTimes = 0.5;  // of sqrt(Ti Td): a start for a series form whose ideal equivalent has complex
                                     // zeros

/// Writes text and value of every setting as it is entered.
void write_texts(const product::Product& product, Fitted& fitted) {
    fitted.texts.clear();
    for (product::Setting& setting : fitted.typed) {
        fitted.texts.push_back(product::typed_text(product, setting));
        if (auto* number = std::get_if<double>(&setting.value)) *number = number_of(fitted.texts.back(), *number);
    }
}

DerivativeRule rule_of(const DeviceModel& device, const IdealPid& pid) {
    return device.derivative.value_or(pid.filter.type == FilterType::derivative ? DerivativeRule::filtered_backward
                                                                                : DerivativeRule::difference);
}

Law program_of(const DeviceModel& device, const IdealPid& pid) {
    return {.gains = to_parallel(pid),
            .Ts = device.Ts,
            .integral = device.integral,
            .derivative = rule_of(device, pid),
            .computation_delay = device.computation_delay,
            .velocity = device.velocity};
}

/// The period at which the block runs: if it is a setting with a resolution, its rounded value.
double period_of(const DeviceModel& device, const product::Settings& typed) {
    const product::Parameter* period = product::parameter_of(*device.product, product::ParameterRole::sample_time);
    if (period == nullptr || period->resolution == 0) return device.Ts;
    for (const product::Setting& setting : typed)
        if (const auto* value = std::get_if<double>(&setting.value); value != nullptr && setting.name == period->name)
            return product::solved(period->term, {}, &product::Quantities::Ts, period->term.Ts, *value) /
                   device.context.seconds_per_time;
    return device.Ts;
}

/// True if the filter is a number of samples that is entered.
bool counts_samples(const DeviceModel& device) {
    return device.sampled() && device.product != nullptr && device.product->filter.kind == product::FilterKind::slope &&
           device.product->filter.value == 0;
}

}  // namespace

IdealPid continuous(IdealPid pid) {
    if (pid.filter.type != FilterType::derivative) pid.c = 0;
    return pid;
}

Expected<Fitted> fit(const DeviceModel& device, const product::Settings& typed) {
    const product::Product& product = *device.product;
    Fitted fitted;
    fitted.product = device.product;
    fitted.context = device.context;
    fitted.settings = fitted.typed = typed;
    write_texts(product, fitted);
    const auto twin = product::to_controller(product, fitted.typed, device.context, fitted.notes);
    if (!twin) return twin.error();
    fitted.controller = *twin;
    product::add_block_notes(product, *twin, device.context, fitted.notes);
    if (!device.sampled()) {
        fitted.law.gains = to_parallel(continuous(*twin));
        return fitted;
    }
    fitted.law = product::sampled_law(product, fitted.typed, device.context, period_of(device, fitted.typed));
    fitted.law.computation_delay = device.computation_delay;
    return fitted;
}

Expected<Fitted> fit(const DeviceModel& device, const IdealPid& pid, bool nearest) {
    if (device.product == nullptr) return Fitted{.controller = pid, .law = program_of(device, pid)};
    auto converted = product::to_settings(*device.product, pid, device.context, nearest);
    if (!converted) return converted.error();
    auto fitted = fit(device, product::as_typed(*device.product, converted->settings));
    if (!fitted) return fitted;
    fitted->settings = std::move(converted->settings);
    for (product::Note& note : fitted->notes)
        if (std::ranges::find(converted->notes, note) == converted->notes.end())
            converted->notes.push_back(std::move(note));
    fitted->notes = std::move(converted->notes);
    return fitted;
}

namespace {

/// The ratio of lag to lead of a series form.
double series_alpha(const product::Product& product) {
    return product.filter.kind == product::FilterKind::ratio ? product.filter.value : product.series_alpha;
}

/// A product's own form: the ideal law for its gain and times.
class OwnForm {
public:
    OwnForm(const DeviceModel& device, const Wish& wish) : device_(device), wish_(wish) {}

    IdealPid controller(double gain, double Ti, double Td) const;

private:
    Filter filter(double Td) const;
    bool series() const { return device_.product != nullptr && device_.product->form == product::Form::series; }

    const DeviceModel& device_;
    const Wish& wish_;
};

Filter OwnForm::filter(double Td) const {
    const double Tf = wish_.filter_time ? wish_.filter_time(Td) : 0;
    if (device_.product == nullptr) return Tf > 0 ? Filter{wish_.filter, Tf} : Filter{};
    using enum product::FilterKind;
    switch (device_.product->filter.kind) {
        case parameter:
        case chosen: return Td > 0 && Tf > 0 ? Filter{FilterType::derivative, Tf} : Filter{};
        case measurement: return Tf > 0 ? Filter{FilterType::measurement_second_order, Tf} : Filter{};
        case ratio: {
            const double fixed = device_.product->filter.value * Td;
            return fixed > 0 ? Filter{FilterType::derivative, fixed} : Filter{};
        }
        case slope: return Td > 0 && Tf > 0 ? Filter{FilterType::derivative, Tf} : Filter{};
        default: return {};
    }
}

IdealPid OwnForm::controller(double gain, double Ti, double Td) const {
    if (!wish_.pid) Td = 0;
    IdealPid pid{.Kp = wish_.sign * gain, .Ti = Ti, .Td = Td, .b = wish_.b, .c = 0, .filter = filter(Td)};
    if (!series() || Td == 0) return pid;
    const double alpha = series_alpha(*device_.product);
    // Kc (1 + 1/(ti s))(1 + td s)/(1 + alpha td s) in the ideal form.
    pid.Ti = Ti + (1 - alpha) * Td;
    pid.Kp *= pid.Ti / Ti;
    pid.Td = (1 - alpha) * Td * (Ti - alpha * Td) / pid.Ti;
    if (alpha > 0) pid.filter = {FilterType::derivative, alpha * Td};
    return pid;
}

/// The start's times in the own form; for a series form the nearest real ones.
Settings start_of(const DeviceModel& device, const Wish& wish) {
    Settings start{wish.start.Kp, wish.start.Ti, wish.start.Td, 0};
    if (device.product == nullptr || device.product->form != product::Form::series || start.Td <= 0) return start;
    const double alpha = series_alpha(*device.product),
                 root = start.Ti * start.Ti - 4 * start.Ti * start.Td / (1 - alpha);
    const double td = root > 0 ? 0.5 * (start.Ti - std::sqrt(root)) : kEqualTimes * std::sqrt(start.Ti * start.Td);
    start.Ti = std::max(start.Ti - (1 - alpha) * td, td);
    start.Td = td;
    return start;
}

/// The rules of the product's program, read from its settings for the start.
Expected<Law> rules_of(const DeviceModel& device, const IdealPid& pid) {
    if (device.product == nullptr) return program_of(device, pid);
    auto fitted = fit(device, pid, true);
    if (!fitted) return fitted.error();
    return fitted->law;
}

/// Gain and times as entered.
struct TypedNumbers {
    explicit TypedNumbers(const DeviceModel& device)
        : gain(device, product::ParameterRole::gain),
          Ti(device, product::ParameterRole::integral),
          Td(device, product::ParameterRole::derivative) {}
    TypedQuantity gain, Ti, Td;
};

/// A design, with the parameters that are still free.
struct Numbers {
    Shape shape;
    Settings found;
};

/// Fixes the settings with coarse steps one after the other, the coarsest first, each at both neighbouring values, and
/// searches the others again: simply rounding a design would exceed the limits or waste what they allow.
class Settling {
public:
    Settling(const DeviceModel& device, const OwnForm& form, const TypedNumbers& numbers,
             const std::vector<const LinearPlant*>& plants, const PeakLimits& limits, const RunControl& control)
        : device_(device), form_(form), numbers_(numbers), plants_(plants), limits_(limits), control_(control) {}

    /// Starts from a design whose numbers are free.
    Expected<Fitted> best(const Numbers& free) {
        settle(free);
        return std::move(best_);
    }

private:
    void settle(const Numbers& from);
    void settle_at(Shape shape, const Settings& start);
    void type(Numbers near);
    void take(Expected<Fitted> typed);

    const DeviceModel& device_;
    const OwnForm& form_;
    const TypedNumbers& numbers_;
    const std::vector<const LinearPlant*>& plants_;
    const PeakLimits& limits_;
    const RunControl& control_;
    Expected<Fitted> best_ = Error{ErrorKind::no_feasible_controller, "", ""};
    double min_ = std::numeric_limits<double>::infinity();
};

void Settling::settle(const Numbers& from) {
    type(from);
    const Settings& found = from.found;
    const double gain = from.shape.gain.low < from.shape.gain.high ? numbers_.gain.step(std::abs(found.gain)) : 0,
                 Ti = from.shape.has_integral ? numbers_.Ti.step(found.Ti) : 0,
                 Td = from.shape.has_derivative ? numbers_.Td.step(found.Td) : 0;
    const double coarsest = std::max({gain, Ti, Td});
    if (coarsest <= kMinCoarseStep) return;
    const TypedQuantity& next = coarsest == gain ? numbers_.gain : coarsest == Td ? numbers_.Td : numbers_.Ti;
    const double size = coarsest == gain ? std::abs(found.gain) : coarsest == Td ? found.Td : found.Ti;
    for (const double choice : next.choices(size)) {
        Shape shape = from.shape;
        if (coarsest == gain) {
            shape.gain = {choice, choice};
        } else if (coarsest == Td) {
            shape.Td = {choice, choice};
            shape.has_derivative = false;
        } else {
            shape.Ti = {choice, choice};
            shape.has_integral = false;
        }
        settle_at(std::move(shape), found);
    }
}

// Fixing more settings never makes the loop faster: a design that is already slower need not be continued.
void Settling::settle_at(Shape shape, const Settings& start) {
    const auto found = search(plants_, shape, limits_, {start}, control_, Reach::near);
    if (found && found->load_IAE < min_) settle({std::move(shape), *found});
}

// Uses the smallest sufficient margin for the rounding: the load IAE rises by a multiple of the margin.
void Settling::type(Numbers near) {
    const double designed = near.found.load_IAE;
    for (const double margin : kMargins) {
        if (min_ <= designed * (1 + kCostOfMargin * margin)) return;
        if (margin > 0) {
            const auto found =
                search(plants_, near.shape, within(limits_, margin), {near.found}, control_, Reach::near);
            if (!found) return;  // the settings found so far give the reason
            near.found = *found;
        }
        auto rounded = fit(device_, form_.controller(std::abs(near.found.gain), near.found.Ti, near.found.Td), true);
        if (rounded) rounded = on_grid(device_, plants_, limits_, std::move(*rounded), min_, control_);
        take(std::move(rounded));
    }
}

void Settling::take(Expected<Fitted> typed) {
    if (!typed) {
        if (!best_) best_ = typed.error();
        return;
    }
    const double IAE = load_iae_of(*plants_.front(), typed->law);
    if (IAE >= min_) return;
    min_ = IAE;
    best_ = std::move(typed);
}

Shape shape_of(const DeviceModel& device, const Wish& wish, const OwnForm& form, const Law& rules,
               const TypedNumbers& numbers) {
    Shape shape;
    shape.has_derivative =
        wish.pid && (device.product == nullptr ||
                     product::parameter_of(*device.product, product::ParameterRole::derivative) != nullptr);
    shape.sign = wish.sign;
    shape.gain = numbers.gain.range();
    shape.Ti = numbers.Ti.range();
    shape.Td = numbers.Td.range();
    shape.law = [&device, &form, rules, counted = counts_samples(device)](double gain, double Ti, double Td) {
        const IdealPid pid = form.controller(gain, Ti, Td);
        Law law = rules;
        law.gains = to_parallel(pid);
        if (counted) law.slope_samples = product::whole_samples(1 + 2 * pid.filter.Tf / device.Ts);
        if (device.product == nullptr) law.derivative = rule_of(device, pid);
        return law;
    };
    return shape;
}

/// A filter with a whole number of samples cannot change with the derivative time: the number is fixed, and the other
/// settings are searched for it. Numbers near that of the filter's rule for the free design are tried.
class WholeSamples {
public:
    WholeSamples(const DeviceModel& device, const Wish& wish, const Law& rules, const TypedNumbers& numbers,
                 const std::vector<const LinearPlant*>& plants, const RunControl& control)
        : device_(device), wish_(wish), rules_(rules), numbers_(numbers), plants_(plants), control_(control) {}

    Expected<Fitted> best(const Numbers& free) const {
        const int at = free.shape.law(std::abs(free.found.gain), free.found.Ti, free.found.Td).slope_samples;
        Settings start = free.found;
        if (const auto there = found(at, start, Reach::wide)) start = *there;
        Expected<Settings> min = Error{ErrorKind::no_feasible_controller, "", ""};
        int samples = at;
        for (int M = std::max(1, at - kMaxFilterSampleOffset); M <= at + kMaxFilterSampleOffset; ++M) {
            const auto next = found(M, start, Reach::near);
            if (!next || (min && next->load_IAE >= min->load_IAE)) continue;
            min = next;
            samples = M;
        }
        if (!min) return typed(at, free.found);
        if (const auto last = found(samples, *min, Reach::near); last && last->load_IAE < min->load_IAE) min = last;
        return typed(samples, *min);
    }

private:
    Wish held_at(int samples) const {
        Wish held = wish_;
        held.filter_time = [Tf = product::slope_filter_time(samples, device_.Ts)](double) { return Tf; };
        return held;
    }
    Expected<Settings> found(int samples, const Settings& start, Reach reach) const {
        const Wish held = held_at(samples);
        const OwnForm form(device_, held);
        return search(plants_, shape_of(device_, held, form, rules_, numbers_), held.limits, {start}, control_, reach);
    }
    Expected<Fitted> typed(int samples, const Settings& settings) const {
        const Wish held = held_at(samples);
        const OwnForm form(device_, held);
        return Settling(device_, form, numbers_, plants_, held.limits, control_)
            .best({shape_of(device_, held, form, rules_, numbers_), settings});
    }

    const DeviceModel& device_;
    const Wish& wish_;
    const Law& rules_;
    const TypedNumbers& numbers_;
    const std::vector<const LinearPlant*>& plants_;
    const RunControl& control_;
};

/// The sign is decided before any search: a controller with the wrong sign is unstable at any gain.
std::optional<Error> wrong_direction(const DeviceModel& device, const Wish& wish) {
    if (device.product == nullptr || device.product->action.kind != product::Action::Kind::reverse_only ||
        wish.sign > 0)
        return std::nullopt;
    return Error{ErrorKind::not_representable, "",
                 std::string(device.product->name) +
                     " cannot control this plant: its gain cannot be negative and it has no switch for the direction, "
                     "but this plant needs a negative Kp. Invert the actuator, so that the plant's gain changes its "
                     "sign. " +
                     std::string(device.product->action.text)};
}

}  // namespace

std::optional<Error> refuse_sampling(const DeviceModel& device, const LinearPlant& plant) {
    return device.sampled() ? tunewright::refuse_sampling(plant, device.Ts, device.computation_delay) : std::nullopt;
}

Expected<Fitted> design(const DeviceModel& device, const std::vector<const LinearPlant*>& plants, const Wish& wish,
                        const RunControl& control) {
    if (device.product != nullptr && device.product->form == product::Form::p_only)
        return Error{ErrorKind::not_representable, "",
                     std::string(device.product->name) +
                         " has only proportional action and cannot represent a design with integral action. Choose "
                         "another controller."};
    if (auto error = wrong_direction(device, wish)) return *error;
    for (const LinearPlant* plant : plants)
        if (const auto error = refuse_sampling(device, *plant)) return *error;
    const OwnForm form(device, wish);
    Settings start = start_of(device, wish);
    const auto rules = rules_of(device, form.controller(std::abs(start.gain), start.Ti, start.Td));
    if (!rules) return rules.error();
    const TypedNumbers numbers(device);
    const Shape shape = shape_of(device, wish, form, *rules, numbers);
    const auto free = search(plants, shape, wish.limits, {start}, control);
    if (!free) return free.error();
    if (device.product == nullptr) return fit(device, form.controller(std::abs(free->gain), free->Ti, free->Td), true);
    if (shape.has_derivative && counts_samples(device))
        return WholeSamples(device, wish, *rules, numbers, plants, control).best({shape, *free});
    return Settling(device, form, numbers, plants, wish.limits, control).best({shape, *free});
}

}  // namespace tunewright::device
