#include "engine/tuning/robust/certified.h"

#include <memory>
#include <string>
#include <utility>

namespace tunewright::robust {
namespace {

/// Why there is no certificate; "" if there can be one.
std::string why_not(const DesignProblem& problem, const RobustOptions& options) {
    if (problem.measured != nullptr) return "The plant is known by points of its frequency response alone.";
    if (!problem.others.empty()) return "The limits hold on several plants, and a certificate is about one.";
    if (options.objective != Objective::load_iae) return "A certificate is about the load IAE. Leave out objective.";
    if (options.constraint != Constraint::circles)
        return "A certificate needs the circles of Ms and Mt. Leave out constraint.";
    if (options.Mks) return "A certificate has no limit on max |C S|. Leave out Mks.";
    return {};
}

}  // namespace

void add_certificate(const DesignProblem& problem, const RobustOptions& options, double upper,
                     const RunControl& control, TunedController& result) {
    if (!options.certify.gap || result.partial) return;
    const auto refuse = [&](std::string why) { result.warnings.push_back({"not-certified", std::move(why)}); };
    if (std::string why = why_not(problem, options); !why.empty()) return refuse(std::move(why));
    const auto design = to_ideal(result.controller);
    if (!design) return refuse(design.error().message);
    const auto posed = certificate_problem(*problem.plant, *design, options.Ms, options.Mt, upper);
    if (!posed) return refuse(posed.error().message);
    const double start = control.now_ms ? control.now_ms() : 0;
    auto proof = certify(*posed, {.gap = *options.certify.gap, .reach = {}}, control);
    if (!proof) return refuse(proof.error().message);
    auto report = std::make_shared<CertificateReport>();
    report->certificate = std::move(*proof);
    if (control.now_ms) report->seconds = (control.now_ms() - start) / 1000;
    result.report = std::move(report);
}

}  // namespace tunewright::robust
