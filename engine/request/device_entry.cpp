#include "engine/request/device_entry.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/evaluation/evaluate.h"
#include "engine/number_text.h"
#include "engine/tuning/robust/degenerate_design.h"

namespace tunewright {
namespace {

constexpr double kMaxUnsaidDifference =
    2;  // percent (of the overshoot: percent of the step); smaller differences are not reported

constexpr const char* kNotIdeal = "The ideal loop has no such figure.";
constexpr const char* kNotBuilt = "The implemented loop has no such figure.";

Figure percent_above(const Figure& on_device, const Figure& ideal) {
    if (on_device && ideal && *ideal != 0) return 100 * (*on_device / *ideal - 1);
    return no_figure(on_device ? kNotIdeal : kNotBuilt);
}

Figure points_above(const Figure& on_device, const Figure& ideal) {
    if (on_device && ideal) return *on_device - *ideal;
    return no_figure(on_device ? kNotIdeal : kNotBuilt);
}

Expected<DeviceLoop> loop_of(const AnalysedPlant& subject, const device::DeviceModel& device,
                             const device::Fitted& fitted, const EvaluateOptions& options) {
    if (device.sampled()) return evaluate_sampled(subject, fitted.law, device.program, options);
    auto evaluation = evaluate(subject, device::continuous(fitted.controller), options);
    if (!evaluation) return evaluation.error();
    return DeviceLoop{evaluation->robustness, evaluation->performance, evaluation->responses, evaluation->region};
}

// The settings closest to the ideal loop: as robust as it is, and as fast as that allows.
Expected<device::Fitted> nearest(const AnalysedPlant& subject, const device::DeviceModel& device, const IdealPid& pid,
                                 const Evaluation& ideal, const Error& why, const RunControl& control) {
    const LinearPlant* plant = subject.linear();
    const Robustness& r = ideal.robustness;
    if (plant == nullptr || !r.stable || !r.Ms || !r.Mt || !pid.has_integral()) return why;
    device::Wish wish;
    constexpr double kMinPeakLimit = 1.001;  // a peak of T that is 1 limits nothing
    wish.limits = {std::max(*r.Ms, kMinPeakLimit), std::max(*r.Mt, kMinPeakLimit), {}};
    wish.pid = pid.Td > 0;
    wish.sign = pid.Kp < 0 ? -1 : 1;
    wish.b = pid.b;
    if (pid.filter.type != FilterType::none && pid.Td > 0)
        wish.filter_time = [ratio = pid.filter.Tf / pid.Td](double Td) { return ratio * Td; };
    wish.start = pid;
    auto fitted = device::design(device, {plant}, wish, control);
    if (!fitted) return why;
    fitted->notes.insert(
        fitted->notes.begin(),
        {"nearest-settings", std::string(device.product->name) +
                                 " cannot represent the method's controller. These settings have the least "
                                 "load IAE that it reaches within the ideal loop's own Ms and Mt."});
    return fitted;
}

}  // namespace

Expected<DeviceEntry> judge_device(const AnalysedPlant& subject, const device::DeviceModel& device,
                                   device::Fitted fitted, const EvaluateOptions& options, const Evaluation& ideal) {
    auto loop = loop_of(subject, device, fitted, options);
    if (!loop) return loop.error();
    DeviceEntry on_device{std::move(fitted), std::move(*loop), {}, {}, {}};
    on_device.Ms_percent = percent_above(on_device.loop.robustness.Ms, ideal.robustness.Ms);
    on_device.load_IAE_percent = percent_above(on_device.loop.performance.load.IAE, ideal.performance.load.IAE);
    on_device.overshoot_points = points_above(on_device.loop.performance.setpoint.overshoot_percent,
                                              ideal.performance.setpoint.overshoot_percent);
    for (const auto& [name, difference] : {std::pair{DifferingFigure::Ms, &on_device.Ms_percent},
                                           {DifferingFigure::load_IAE, &on_device.load_IAE_percent},
                                           {DifferingFigure::overshoot, &on_device.overshoot_points}})
        if (on_device.loop.robustness.stable && *difference && std::abs(**difference) > kMaxUnsaidDifference)
            on_device.differs.push_back(name);
    return on_device;
}

Expected<DeviceEntry> device_entry_of(const AnalysedPlant& subject, const device::DeviceModel& device,
                                      const EvaluateOptions& options, const Evaluation& ideal,
                                      const RunControl& control) {
    if (std::holds_alternative<Npid>(ideal.controller))
        return Error{ErrorKind::unsupported, "",
                     "No product and no sampled law here has the nonlinear integral of this controller; only the ideal "
                     "loop is evaluated."};
    const auto pid = to_ideal(ideal.controller);
    if (!pid) return pid.error();
    auto fitted = device::fit(device, *pid);
    if (!fitted && fitted.error().kind == ErrorKind::not_representable)
        fitted = nearest(subject, device, *pid, ideal, fitted.error(), control);
    if (!fitted) return fitted.error();
    return judge_device(subject, device, std::move(*fitted), options, ideal);
}

namespace {

void warn_of_difference(Evaluation& evaluation, const DeviceEntry& on_device) {
    if (!on_device.loop.robustness.stable) {
        evaluation.warnings.push_back(
            {"unstable-as-built",
             "The implemented loop is unstable: sample faster, or design for the controller with the method robust."});
        return;
    }
    std::string moved;
    const auto note = [&](DifferingFigure which, const Figure& percent, const char* what) {
        if (std::ranges::find(on_device.differs, which) == on_device.differs.end()) return;
        moved += (moved.empty() ? "" : " and ") + std::string(what) + " by " + text(*percent, 3) + " %";
    };
    note(DifferingFigure::Ms, on_device.Ms_percent, "Ms");
    note(DifferingFigure::load_IAE, on_device.load_IAE_percent, "the load IAE");
    if (moved.empty()) return;
    evaluation.warnings.push_back(
        {"differs-as-built", "The implemented controller, with its rounding and sampling, changes " + moved +
                                 " from the ideal loop; the figures of both are given."});
}

}  // namespace

void take_device_entry(Expected<DeviceEntry> on_device, Evaluation& evaluation, std::optional<DeviceEntry>& entry) {
    if (!on_device) {
        evaluation.warnings.push_back({"not-as-built", on_device.error().message});
        return;
    }
    warn_of_difference(evaluation, *on_device);
    if (const Robustness& r = on_device->loop.robustness; r.stable && r.omega_Ms)
        if (auto degenerate = robust::degenerate_design(*r.omega_Ms, on_device->fitted.controller.Ti,
                                                        on_device->fitted.controller.Td))
            evaluation.warnings.push_back(std::move(*degenerate));
    entry = std::move(*on_device);
}

}  // namespace tunewright
