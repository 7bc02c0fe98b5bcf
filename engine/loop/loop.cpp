#include "engine/loop/loop.h"

#include <cmath>
#include <limits>

#include "engine/loop/controller_fraction.h"
#include "engine/numerics/fast_complex.h"
#include "engine/numerics/pair_complex.h"
#include "engine/plant/linear/plant_fraction.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr double kMinWellPosedness = 1e-12;  // |1 + L(infinity)|: below it the algebraic loop has no accurate solution

Error invalid(const std::string& message) { return {ErrorKind::invalid_argument, "controller", message}; }

int filter_order(FilterType type) {
    switch (type) {
        case FilterType::none: return 0;
        case FilterType::derivative:
        case FilterType::measurement_first_order: return 1;
        case FilterType::measurement_second_order: return 2;
    }
    return 0;
}

}  // namespace

std::optional<Error> check_controller(const ParallelPid& gains) {
    for (const double value : {gains.Kp, gains.Ki, gains.Kd, gains.b, gains.c, gains.filter.Tf})
        if (!std::isfinite(value)) return invalid("Every controller parameter must be a finite number.");
    if (gains.Kp == 0 && gains.Ki == 0 && gains.Kd == 0)
        return invalid("All gains are 0, so the controller has no effect. Give a gain that is not 0.");
    if (gains.filter.type != FilterType::none && !(gains.filter.Tf > 0))
        return Error{ErrorKind::invalid_argument, "controller/filter/Tf", "A filter needs Tf > 0."};
    if (gains.c != 0 && gains.Kd != 0 && gains.filter.type != FilterType::derivative)
        return Error{ErrorKind::invalid_argument, "controller/c",
                     "c is not 0, so a set-point step is differentiated: that needs the filter type \"derivative\". "
                     "Use c = 0 or that filter."};
    return std::nullopt;
}

Expected<Loop> Loop::make(const LinearPlant& plant, const ParallelPid& gains) {
    if (auto error = check_controller(gains)) return *error;
    const Loop loop(plant, gains);
    const double q = loop.signed_high_frequency_gain();
    if (!std::isfinite(q))
        return Error{ErrorKind::invalid_argument, "controller/filter",
                     "A derivative without filter on a plant with a direct term has infinite loop gain. Give the "
                     "controller a filter."};
    if (plant.dead_time() == 0 && std::abs(1 + q) < kMinWellPosedness)
        return invalid(
            "The loop is not well posed: 1 + L is 0 at infinite frequency. Add a filter or change the gain.");
    return loop;
}

Complex controller_response(const ParallelPid& gains, Complex s) {
    const auto c = controller_fraction(gains, s);
    return quotient(c.numerator, c.denominator);
}

Complex Loop::controller(Complex s) const { return controller_response(gains_, s); }

Complex Loop::open_loop(Complex s) const {
    const auto l = fraction(s);
    return quotient(l.numerator, l.denominator);
}

inline Loop::Parts Loop::parts(Complex s) const {
    const auto c = controller_fraction(gains_, s);
    const auto p = plant_fraction(*plant_, s);
    Parts parts{c.numerator, c.denominator, p.numerator, p.denominator};
    if (plant_->dead_time() > 0) parts.plant_numerator = product(parts.plant_numerator, delay_of(*plant_, s));
    return parts;
}

Loop::Fraction Loop::fraction(Complex s) const {
    const Parts p = parts(s);
    return {product(p.controller_numerator, p.plant_numerator), product(p.controller_denominator, p.plant_denominator)};
}

int Loop::denominator_degree() const {
    return plant_->order() + filter_order(gains_.filter.type) + (gains_.Ki != 0 ? 1 : 0);
}

LoopPoint Loop::at(double omega) const {
    const Parts p = parts({0, omega});
    const Complex numerator = product(p.controller_numerator, p.plant_numerator);
    const Complex denominator = product(p.controller_denominator, p.plant_denominator);
    const Divisor sum(denominator + numerator);
    LoopPoint point;
    point.L = quotient(numerator, denominator);
    point.S = sum.under(denominator);
    point.T = sum.under(numerator);
    // C S = T/P: computed with P's fraction, so that it stays finite where C is infinite (omega = 0).
    point.CS = sum.under(product(p.controller_numerator, p.plant_denominator));
    return point;
}

bool Loop::pair_at(const double* omega, LoopPoint* to) const {
    const Pair w = load(omega), angle = w * -plant_->dead_time();
    if (!in_reach(angle)) return false;
    const PairComplex s(Pair{}, w);
    const auto c = controller_fraction(gains_, s);
    auto p = plant_fraction(*plant_, s);
    if (plant_->dead_time() > 0) p.numerator = product(p.numerator, unit_circle(angle));
    const PairComplex numerator = product(c.numerator, p.numerator),
                      denominator = product(c.denominator, p.denominator);
    const PairComplex sum = denominator + numerator;
    const Pair square = norm(denominator), of_sum = norm(sum);
    if (!ordinary(square) || !ordinary(of_sum)) return false;
    const PairComplex inverse = quotient(1, sum, of_sum), L = quotient(numerator, denominator, square),
                      S = product(denominator, inverse), T = product(numerator, inverse),
                      CS = product(product(c.numerator, p.denominator), inverse);
    for (std::size_t i = 0; i < 2; ++i)
        to[i] = {{L.re[i], L.im[i]}, {S.re[i], S.im[i]}, {T.re[i], T.im[i]}, {CS.re[i], CS.im[i]}};
    return true;
}

std::vector<LoopPoint> Loop::at(std::span<const double> omega) const {
    std::vector<LoopPoint> points(omega.size());
    in_pairs(
        omega, points.data(), [this](double w) { return at(w); },
        [this](const double* w, LoopPoint* to) { return pair_at(w, to); });
    return points;
}

LoopGrid Loop::ends() const {
    LoopPoint zero = at(0);
    if (!std::isfinite(magnitude(zero.CS))) zero.CS = 0;
    // With a dead time L takes every direction again and again, also the worst.
    const double q = signed_high_frequency_gain(), L = plant_->dead_time() > 0 ? -std::abs(q) : q, nearest = 1 + L;
    return {{0, std::numeric_limits<double>::infinity()},
            {zero, {L, 1 / nearest, L / nearest, controller_high_frequency_gain() / nearest}}};
}

int Loop::controller_excess() const {
    const int integral = gains_.Ki != 0 ? 1 : 0;
    const int denominator = filter_order(gains_.filter.type) + integral;
    int numerator = 0;
    if (gains_.filter.type == FilterType::derivative) {
        const bool proper = gains_.Kp * gains_.filter.Tf + gains_.Kd != 0;
        numerator = (proper ? 1 : 0) + integral;
    } else {
        numerator = (gains_.Kd != 0 ? 1 : 0) + integral;
        if (gains_.Kd == 0 && gains_.Kp == 0) numerator = 0;
    }
    return denominator - numerator;
}

double Loop::controller_leading_coefficient() const {
    const double Tf = gains_.filter.Tf;
    const double numerator = gains_.Kd != 0 ? gains_.Kd : gains_.Kp != 0 ? gains_.Kp : gains_.Ki;
    switch (gains_.filter.type) {
        case FilterType::none: return numerator;
        case FilterType::derivative:
            return gains_.Kp + gains_.Kd / Tf != 0 ? gains_.Kp + gains_.Kd / Tf : gains_.Kp / Tf;
        case FilterType::measurement_first_order: return numerator / Tf;
        case FilterType::measurement_second_order: return 2 * numerator / (Tf * Tf);
    }
    return numerator;
}

double Loop::signed_high_frequency_gain() const {
    const int excess = plant_->pole_excess() + controller_excess();
    if (excess > 0) return 0;
    if (excess < 0) return std::numeric_limits<double>::infinity();
    return plant_->gain() * controller_leading_coefficient();
}

double Loop::high_frequency_gain() const { return std::abs(signed_high_frequency_gain()); }

double Loop::controller_high_frequency_gain() const {
    if (controller_excess() > 0) return 0;
    if (controller_excess() < 0) return std::numeric_limits<double>::infinity();
    return controller_leading_coefficient();
}

}  // namespace tunewright
