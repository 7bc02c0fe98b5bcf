#include "engine/tuning/built/build.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/number_text.h"
#include "engine/tuning/built/typed_grid.h"

namespace tunewright::built {
namespace {

// Of M - 1, left for the rounding of what is typed: the least with which settings are found that hold the limits.
constexpr double kMargins[] = {0, 0.001, 0.004, 0.015, 0.05};
constexpr double kEqualTimes = 0.5;  // of sqrt(Ti Td): a start of a series form whose ideal twin has complex zeros

/// Text and value of what is typed, one for each setting.
void write_texts(const product::Product& product, Fitted& fitted) {
    fitted.texts.clear();
    for (product::Setting& setting : fitted.typed) {
        fitted.texts.push_back(product::typed_text(product, setting));
        if (auto* number = std::get_if<double>(&setting.value)) *number = number_of(fitted.texts.back(), *number);
    }
}

DerivativeRule rule_of(const Build& build, const IdealPid& pid) {
    return build.derivative.value_or(pid.filter.type == FilterType::derivative ? DerivativeRule::filtered_backward
                                                                               : DerivativeRule::difference);
}

Law program_of(const Build& build, const IdealPid& pid) {
    return {.gains = to_parallel(pid),
            .Ts = build.Ts,
            .integral = build.integral,
            .derivative = rule_of(build, pid),
            .computation_delay = build.computation_delay,
            .velocity = build.velocity};
}

}  // namespace

IdealPid continuous(IdealPid pid) {
    if (pid.filter.type != FilterType::derivative) pid.c = 0;
    return pid;
}

Expected<Fitted> fit(const Build& build, const product::Settings& typed) {
    const product::Product& product = *build.product;
    Fitted fitted;
    fitted.product = build.product;
    fitted.settings = fitted.typed = typed;
    write_texts(product, fitted);
    const auto twin = product::to_controller(product, fitted.typed, build.context, fitted.notes);
    if (!twin) return twin.error();
    fitted.controller = *twin;
    if (!build.sampled()) {
        fitted.law.gains = to_parallel(continuous(*twin));
        return fitted;
    }
    fitted.law = product::sampled_law(product, fitted.typed, build.context, build.Ts);
    fitted.law.computation_delay = build.computation_delay;
    return fitted;
}

Expected<Fitted> fit(const Build& build, const IdealPid& pid, bool nearest) {
    if (build.product == nullptr) return Fitted{nullptr, pid, program_of(build, pid), {}, {}, {}, {}};
    auto converted = product::to_settings(*build.product, pid, build.context, nearest);
    if (!converted) return converted.error();
    auto fitted = fit(build, product::as_typed(*build.product, converted->settings));
    if (!fitted) return fitted;
    fitted->settings = std::move(converted->settings);
    fitted->notes.insert(fitted->notes.begin(), converted->notes.begin(), converted->notes.end());
    return fitted;
}

namespace {

/// The ratio of lag to lead of a series form.
double series_alpha(const product::Product& product) {
    return product.filter.kind == product::FilterKind::ratio ? product.filter.value : product.series_alpha;
}

/// A product's own form: which ideal law its gain and times make.
class OwnForm {
public:
    OwnForm(const Build& build, const Wish& wish) : build_(build), wish_(wish) {}

    IdealPid controller(double gain, double Ti, double Td) const;

private:
    Filter filter(double Td) const;
    bool series() const { return build_.product != nullptr && build_.product->form == product::Form::series; }

    const Build& build_;
    const Wish& wish_;
};

Filter OwnForm::filter(double Td) const {
    const double Tf = wish_.filter_time ? wish_.filter_time(Td) : 0;
    if (build_.product == nullptr) return Tf > 0 ? Filter{wish_.filter, Tf} : Filter{};
    using enum product::FilterKind;
    switch (build_.product->filter.kind) {
        case parameter:
        case chosen: return Td > 0 && Tf > 0 ? Filter{FilterType::derivative, Tf} : Filter{};
        case measurement: return Tf > 0 ? Filter{FilterType::measurement_second_order, Tf} : Filter{};
        case ratio: {
            const double fixed = build_.product->filter.value * Td;
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
    const double alpha = series_alpha(*build_.product);
    // Kc (1 + 1/(ti s))(1 + td s)/(1 + alpha td s) in the ideal form.
    pid.Ti = Ti + (1 - alpha) * Td;
    pid.Kp *= pid.Ti / Ti;
    pid.Td = (1 - alpha) * Td * (Ti - alpha * Td) / pid.Ti;
    if (alpha > 0) pid.filter = {FilterType::derivative, alpha * Td};
    return pid;
}

/// The start's times in the own form: of a series form the real ones nearby.
Settings start_of(const Build& build, const Wish& wish) {
    Settings start{wish.start.Kp, wish.start.Ti, wish.start.Td, 0};
    if (build.product == nullptr || build.product->form != product::Form::series || start.Td <= 0) return start;
    const double alpha = series_alpha(*build.product),
                 root = start.Ti * start.Ti - 4 * start.Ti * start.Td / (1 - alpha);
    const double td = root > 0 ? 0.5 * (start.Ti - std::sqrt(root)) : kEqualTimes * std::sqrt(start.Ti * start.Td);
    start.Ti = std::max(start.Ti - (1 - alpha) * td, td);
    start.Td = td;
    return start;
}

/// The rules of the product's program, from its settings for the start.
Expected<Law> rules_of(const Build& build, const IdealPid& pid) {
    if (build.product == nullptr) return program_of(build, pid);
    auto fitted = fit(build, pid, true);
    if (!fitted) return fitted.error();
    return fitted->law;
}

}  // namespace

Expected<Fitted> design(const Build& build, const std::vector<const LinearPlant*>& plants, const Wish& wish,
                        const RunControl& control) {
    if (build.product != nullptr && build.product->form == product::Form::p_only)
        return Error{ErrorKind::not_representable, "",
                     std::string(build.product->name) +
                         " has proportional action alone, and a design with integral "
                         "action cannot be typed into it. Choose another controller."};
    const OwnForm form(build, wish);
    Settings start = start_of(build, wish);
    const auto rules = rules_of(build, form.controller(std::abs(start.gain), start.Ti, start.Td));
    if (!rules) return rules.error();
    const bool slope = build.product != nullptr && build.product->filter.kind == product::FilterKind::slope &&
                       build.product->filter.value == 0;
    Shape shape;
    shape.has_derivative = wish.pid && (build.product == nullptr ||
                                        product::parameter_of(*build.product, product::Role::derivative) != nullptr);
    shape.sign = wish.sign;
    shape.law = [&](double gain, double Ti, double Td) {
        const IdealPid pid = form.controller(gain, Ti, Td);
        Law law = *rules;
        law.gains = to_parallel(pid);
        if (slope && build.sampled())
            law.slope_samples = std::max(1, static_cast<int>(std::lround(1 + 2 * pid.filter.Tf / build.Ts)));
        if (build.product == nullptr) law.derivative = rule_of(build, pid);
        return law;
    };
    Expected<Fitted> last = Error{};
    for (const double margin : kMargins) {
        const auto found = search(plants, shape, within(wish.limits, margin), {start}, control);
        if (!found) return found.error();
        start = *found;
        last = fit(build, form.controller(std::abs(found->gain), found->Ti, found->Td), true);
        if (!last || build.product == nullptr) return last;
        last = on_grid(build, plants, wish.limits, std::move(*last), control);
        if (last || last.error().kind != ErrorKind::no_feasible_controller) return last;
    }
    return last;
}

}  // namespace tunewright::built
