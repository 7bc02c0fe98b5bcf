#include "engine/tuning/model_based/imc.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"

namespace tunewright {

namespace {

// K e^(-Ls)/(1 + n1 s + n2 s^2).
struct Model {
    double K = 0, n1 = 0, n2 = 0, L = 0;
    bool second_order() const { return n2 > 0; }
};

// f = 1/(lambda s + 1)^n.
struct ImcFilter {
    double lambda = 0;
    int n = 1;
};

double binomial(int n, int k) {
    double value = 1;
    for (int i = 0; i < k; ++i) value = value * (n - i) / (i + 1);
    return value;
}

IdealPid by_maclaurin(const Model& model, const ImcFilter& f) {
    std::array<double, 4> d{};
    double power = 1, dead = 1;  // lambda^k and (-L)^k/k!
    for (int k = 1; k <= 4; ++k) {
        power *= f.lambda;
        dead *= -model.L / k;
        d[static_cast<std::size_t>(k - 1)] = (k <= f.n ? binomial(f.n, k) * power : 0) - dead;
    }
    return maclaurin_pid(imc_terms(model.K, model.n1, model.n2, d));
}

// (1 + a1 s + a2 s^2)/(K s (d0 + d1 s)): a PID with the filter time d1/d0.
IdealPid by_pade(const Model& model, const ImcFilter& f) {
    const double half = model.L / 2, lambda = f.lambda;
    const double a1 = model.second_order() ? model.n1 : model.n1 + half;
    const double a2 = model.second_order() ? model.n2 : model.n1 * half;
    const double d0 = f.n * lambda + (model.second_order() ? model.L : half);
    const double Tf = f.n == 2 ? lambda * lambda / d0 : 0;
    const double Kp = (a1 - Tf) / (model.K * d0);
    IdealPid pid{.Kp = Kp, .Ti = a1 - Tf, .Td = a2 / (a1 - Tf) - Tf};
    if (Tf > 0) pid.filter = {FilterType::derivative, Tf};
    return pid;
}

// A stable plant of two poles without zeros is its own model, even if it oscillates.
std::optional<Model> exact_second_order(const LinearPlant& plant) {
    if (plant.poles().size() != 2 || plant.integrators() != 0 || !plant.zeros().empty()) return std::nullopt;
    const auto p = plant.poles()[0], q = plant.poles()[1];
    if (!(p.real() < 0) || !(q.real() < 0)) return std::nullopt;
    const double product = (p * q).real();
    return Model{plant.low_frequency_gain(), -(p + q).real() / product, 1 / product, plant.dead_time()};
}

std::optional<Error> unfit(const ReducedModel& model) {
    if (model.integrators == 0) return std::nullopt;
    return degenerate(
        "plant",
        "This plant integrates: with this controller's filter a constant load at its input would leave a steady-state "
        "error.",
        "Use simc, lambda, amigo or robust.");
}

Error no_pid(const IdealPid& pid, const ImcFilter& f) {
    const bool is_default_order = f.n == 1;
    if (!std::isfinite(pid.Kp) || !std::isfinite(pid.Ti) || !std::isfinite(pid.Td))
        return {ErrorKind::no_feasible_controller, "plant",
                "The plant has a direct term, for which the settings of this method are not finite. Use robust."};
    return {ErrorKind::no_feasible_controller, "lambda",
            "lambda = " + text(f.lambda) + " with filter_order " + std::to_string(f.n) + " gives Kp = " + text(pid.Kp) +
                ", Ti = " + text(pid.Ti) + ", Td = " + text(pid.Td) +
                ", which is not a PID with the sign of the plant's gain and Td >= 0. Use a smaller lambda" +
                (is_default_order ? "." : ", or filter_order 1.")};
}

Expected<ReducedModel> model_of(const TuningProblem& problem, const ReductionOptions& options, bool& exact) {
    exact = exact_second_order(problem.linear).has_value();
    if (exact) {
        ReducedModel as_given;
        as_given.exact = true;
        return as_given;
    }
    return rule_model(problem, options, {.order = ReducedOrder::second, .preferred = ReductionMethod::half_rule});
}

}  // namespace

Expected<TunedController> tune_imc(const TuningProblem& problem, const ImcOptions& options) {
    bool exact = false;
    const auto reduced = model_of(problem, options.reduction, exact);
    if (!reduced) return reduced.error();
    if (const auto error = unfit(*reduced)) return *error;
    const Model model = exact ? *exact_second_order(problem.linear)
                              : Model{reduced->K, reduced->T1 + reduced->T2, reduced->T1 * reduced->T2, reduced->L};
    const ImcFilter f{.lambda = options.lambda.value_or(std::max(model.L, 0.1 * model.n1)),
                      .n = options.filter_order.value_or(model.second_order() ? 2 : 1)};
    if (!(f.lambda > 0))
        return degenerate("plant/L", "The default lambda is the dead time, but the model has none.",
                          "Give lambda, the closed-loop time constant that you want.");
    const bool pade = options.expansion == ImcExpansion::pade;
    IdealPid pid = pade ? by_pade(model, f) : by_maclaurin(model, f);
    if (!(model.K * pid.Kp > 0) || !(pid.Ti > 0) || !(pid.Td >= 0)) return no_pid(pid, f);
    const bool own_filter = pid.filter.type != FilterType::none;
    if (own_filter && options.filter)
        return Error{ErrorKind::invalid_argument, "filter",
                     "The pade expansion with filter_order 2 has its own filter time. Omit filter, or use filter_order "
                     "1."};
    if (!own_filter)
        pid.filter = chosen_filter(options.filter.value_or(FilterOptions{}), FilterType::derivative, pid.Td);
    if (pid.Td == 0) pid.filter = {};

    std::vector<Warning> warnings;
    const double min = std::max(0.25 * model.L, 0.02 * model.n1);
    if (f.lambda < min)
        warnings.push_back(outside_validity("lambda = " + text(f.lambda) + " is below " + text(min) +
                                            ": the PID differs much from the controller that it approximates. Use a "
                                            "larger lambda."));
    auto answer = rule_answer(problem, *reduced, pid, std::move(warnings));
    if (answer && exact) answer->reduced_model.reset();
    return answer;
}

TuningMethod imc_method() {
    TuningMethod method;
    method.id = kImc;
    method.title = "Internal model control";
    method.formula =
        "model K e^(-L s)/(1 + n1 s + n2 s^2); maclaurin: d_k = C(n, k+1) lambda^(k+1) - (-L)^(k+1)/(k+1)!, Ki = 1/(K "
        "d0), "
        "Kp = (n1 - d1/d0)/(K d0), Kd = (n2/K - d1 Kp - d2 Ki)/d0; "
        "pade, first order, n = 1: Kp = (2 T + L)/(K (2 lambda + L)), Ti = T + L/2, Td = T L/(2 T + L); "
        "second order, n = 1: Kp = n1/(K (lambda + L)), Ti = n1, Td = n2/n1";
    method.source =
        "Rivera, Morari and Skogestad, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 252-265; Morari and Zafiriou, "
        "Robust "
        "Process Control (1989); Maclaurin: Liu and Gao, IFAC World Congress (2008)";
    method.needs = "fopdt or stable sopdt, also oscillatory (others are reduced)";
    method.validity = "lambda above about 0.25 L; with a long lag the response to loads is slow";
    OptionSet<ImcOptions> options;
    options.field(&ImcOptions::lambda, "lambda",
                  "Time constant of the closed loop's filter 1/(lambda s + 1)^n: larger is slower and more robust. "
                  "Default: the larger of the dead time and a tenth of the lags.",
                  {.unit = "time", .exclusive_minimum = 0});
    options.field(&ImcOptions::filter_order, "filter_order", "n of that filter, 1 or 2. Default: the model's order.",
                  {.minimum = 1, .maximum = 2});
    options.choice(&ImcOptions::expansion, "expansion",
                   "maclaurin: the first three terms of the controller's series, with the exact dead time; pade: the "
                   "dead time is first replaced by a fraction (1/1 on a first-order model, 1 - L s on a second-order "
                   "one).",
                   Words<ImcExpansion>{{"maclaurin", ImcExpansion::maclaurin}, {"pade", ImcExpansion::pade}});
    options.main({"lambda"}).slider("lambda");
    add_reduction(options, "half_rule; tangent (first order) if that does not apply.");
    add_filter(options, "of the derivative part, Td s/(1 + s Tf).");
    method.bind(options, tune_imc);
    return method;
}

namespace {

constexpr double kRelativeRounding = 1e-12;

}  // namespace

ImcTerms imc_terms(double K, double n1, double n2, const std::array<double, 4>& d) {
    const double m0 = 1 / d[0];
    const double m1 = (n1 - d[1] * m0) / d[0];
    double m2 = (n2 - d[1] * m1 - d[2] * m0) / d[0];
    // The terms can cancel to the last digit, as for a plant without dead time.
    if (std::abs(m2 * d[0]) <= kRelativeRounding * (std::abs(n2) + std::abs(d[1] * m1) + std::abs(d[2] * m0))) m2 = 0;
    const double m3 = (-d[1] * m2 - d[2] * m1 - d[3] * m0) / d[0];
    return {m0 / K, m1 / K, m2 / K, m3 / K};
}

IdealPid maclaurin_pid(const ImcTerms& m) { return {.Kp = m.m1, .Ti = m.m1 / m.m0, .Td = m.m2 / m.m1}; }

std::optional<double> linear_fraction_Tf(const ImcTerms& m) {
    if (m.m2 == 0) return std::nullopt;
    const double Tf = -m.m3 / m.m2;
    return Tf > 0 ? std::optional(Tf) : std::nullopt;
}

}  // namespace tunewright
