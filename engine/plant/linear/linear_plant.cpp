#include "engine/plant/linear/linear_plant.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/plant/linear/factor.h"
#include "engine/plant/linear/plant_fraction.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr double kMinRelativeRealPart = 1e-10;  // of a root's size: computed roots on the axis have a smaller real part
constexpr double kMinDivisor = 1e-300;          // stands for 0 as a divisor

/// (b2 s^2 + b1 s + b0)/(s^2 + a1 s + a0) of order 2, or (b1 s + b0)/(s + a0) of order 1.
struct Section {
    int order = 1;
    double a1 = 0, a0 = 0;
    double b2 = 0, b1 = 0, b0 = 1;
};

struct Roots {
    std::vector<double> real;
    std::vector<Complex> pairs;  // the member with positive imaginary part
};

Roots split(const std::vector<Complex>& values, int at_origin) {
    Roots roots;
    for (const Complex value : values) {
        if (value.imag() == 0) roots.real.push_back(value.real());
        if (value.imag() > 0) roots.pairs.push_back(value);
    }
    roots.real.insert(roots.real.end(), static_cast<std::size_t>(std::max(at_origin, 0)), 0.0);
    std::sort(roots.real.begin(), roots.real.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
    return roots;
}

double take_nearest(std::vector<double>& from, double magnitude) {
    const auto at = std::min_element(from.begin(), from.end(), [magnitude](double x, double y) {
        return std::abs(std::abs(x) - magnitude) < std::abs(std::abs(y) - magnitude);
    });
    const double value = *at;
    from.erase(at);
    return value;
}

/// Denominators: complex pairs, then as many pairs of real poles as the complex zeros still need, then single real
/// poles.
std::vector<Section> denominators(Roots poles, std::size_t zero_pairs) {
    std::vector<Section> sections;
    for (const Complex pole : poles.pairs)
        sections.push_back({.order = 2, .a1 = -2 * pole.real(), .a0 = std::norm(pole)});
    while (sections.size() < zero_pairs) {
        const double first = poles.real.back();
        poles.real.pop_back();
        const double second = take_nearest(poles.real, std::abs(first));
        sections.push_back({.order = 2, .a1 = -(first + second), .a0 = first * second});
    }
    for (const double pole : poles.real) sections.push_back({.order = 1, .a1 = 0, .a0 = -pole});
    return sections;
}

/// Numerators: complex zero pairs go to second-order sections, real zeros to the nearest section with room.
void give_zeros(std::vector<Section>& sections, Roots zeros) {
    std::vector<int> room;
    room.reserve(sections.size());
    for (auto& section : sections) room.push_back(section.order);
    for (std::size_t i = 0; i < zeros.pairs.size(); ++i) {
        sections[i].b2 = 1;
        sections[i].b1 = -2 * zeros.pairs[i].real();
        sections[i].b0 = std::norm(zeros.pairs[i]);
        room[i] = 0;
    }
    for (const double zero : zeros.real) {
        std::size_t best = sections.size();
        double distance = 0;
        for (std::size_t i = 0; i < sections.size(); ++i) {
            if (room[i] == 0) continue;
            const double corner =
                sections[i].order == 1 ? std::abs(sections[i].a0) : std::sqrt(std::abs(sections[i].a0));
            const double gap = std::abs(corner - std::abs(zero));
            if (best == sections.size() || gap < distance) {
                best = i;
                distance = gap;
            }
        }
        Section& section = sections[best];
        // Multiplies the numerator by (s - zero).
        section.b2 = section.b1;
        section.b1 = section.b0 - zero * section.b1;
        section.b0 = -zero * section.b0;
        --room[best];
    }
}

/// Scales the numerator so that the static gain is one (if finite and non-zero); returns the factor that was removed.
double normalise(Section& section) {
    if (section.a0 == 0 || section.b0 == 0) return 1;
    const double factor = section.b0 / section.a0;
    section.b2 /= factor;
    section.b1 /= factor;
    section.b0 /= factor;
    return factor;
}

/// x' = F x + g v, w = h x + k v of one section with state x1 (and x2 = x1'/omega).
struct SectionStates {
    int n = 0;
    std::array<double, 4> F{};
    std::array<double, 2> g{}, h{};
    double k = 0;
};

SectionStates states_of(const Section& section) {
    SectionStates states;
    states.n = section.order;
    if (section.order == 1) {
        // w = b1 v + (b0 - b1 a0)/(s + a0) v; the state has the scale of the input.
        const double scale = section.a0 != 0 ? std::abs(section.a0) : 1;
        states.F = {-section.a0, 0, 0, 0};
        states.g = {scale, 0};
        states.h = {(section.b0 - section.b1 * section.a0) / scale, 0};
        states.k = section.b1;
    } else {
        const double omega =
            section.a0 != 0 ? std::sqrt(std::abs(section.a0)) : std::max(std::abs(section.a1), kMinDivisor);
        states.F = {0, omega, -section.a0 / omega, -section.a1};
        states.g = {0, omega};
        states.h = {(section.b0 - section.b2 * section.a0) / (omega * omega),
                    (section.b1 - section.b2 * section.a1) / omega};
        states.k = section.b2;
    }
    return states;
}

/// Plain loops: with blocks of Eigen a plant takes 2 to 20 % longer to make (orders 1 to 8).
void append(Realisation& whole, const SectionStates& part) {
    const int n = whole.n + part.n;
    std::vector<double> A(static_cast<std::size_t>(n * n), 0.0), B(static_cast<std::size_t>(n)),
        C(static_cast<std::size_t>(n));
    const auto at = [n](int i, int j) { return static_cast<std::size_t>(i * n + j); };
    for (int i = 0; i < whole.n; ++i) {
        for (int j = 0; j < whole.n; ++j) A[at(i, j)] = whole.A[static_cast<std::size_t>(i * whole.n + j)];
        B[static_cast<std::size_t>(i)] = whole.B[static_cast<std::size_t>(i)];
        C[static_cast<std::size_t>(i)] = part.k * whole.C[static_cast<std::size_t>(i)];
    }
    for (int i = 0; i < part.n; ++i) {
        const auto row = static_cast<std::size_t>(whole.n + i);
        for (int j = 0; j < part.n; ++j) A[at(whole.n + i, whole.n + j)] = part.F[static_cast<std::size_t>(2 * i + j)];
        for (int j = 0; j < whole.n; ++j)
            A[at(whole.n + i, j)] = part.g[static_cast<std::size_t>(i)] * whole.C[static_cast<std::size_t>(j)];
        B[row] = part.g[static_cast<std::size_t>(i)] * whole.D;
        C[row] = part.h[static_cast<std::size_t>(i)];
    }
    whole.D *= part.k;
    whole.n = n;
    whole.A = std::move(A);
    whole.B = std::move(B);
    whole.C = std::move(C);
}

Realisation cascade(const Factors& factors) {
    const Roots zeros = split(factors.zeros, -factors.integrators);
    std::vector<Section> sections = denominators(split(factors.poles, factors.integrators), zeros.pairs.size());
    give_zeros(sections, zeros);
    Realisation whole;
    whole.D = factors.gain;
    for (auto& section : sections) whole.D *= normalise(section);
    for (const auto& section : sections) append(whole, states_of(section));
    return whole;
}

Realisation as_given(const StateSpace& plant) {
    Realisation realisation;
    realisation.n = static_cast<int>(plant.A.size());
    realisation.A = row_by_row(plant.A);
    realisation.B = plant.B;
    realisation.C = plant.C;
    realisation.D = plant.D;
    return realisation;
}

}  // namespace

double dead_time(const Plant& plant) {
    return std::visit([](const auto& p) { return p.L; }, plant);
}

Expected<LinearPlant> LinearPlant::make(const Plant& plant) {
    auto factors = factor(plant);
    if (!factors) return factors.error();
    LinearPlant result;
    result.gain_ = factors->gain;
    result.integrators_ = factors->integrators;
    result.L_ = tunewright::dead_time(plant);
    result.zeros_ = factors->zeros;
    result.poles_ = factors->poles;
    result.realisation_ =
        std::holds_alternative<StateSpace>(plant) ? as_given(std::get<StateSpace>(plant)) : cascade(*factors);
    return result;
}

std::complex<double> LinearPlant::rational(std::complex<double> s) const {
    const auto p = plant_fraction(*this, s);
    return quotient(p.numerator, p.denominator);
}

std::complex<double> LinearPlant::at(std::complex<double> s) const {
    return L_ == 0 ? rational(s) : product(rational(s), delay_of(*this, s));
}

std::vector<std::complex<double>> LinearPlant::at(std::span<const double> omega) const {
    const auto pair = [this](const double* w, std::complex<double>* to) {
        const Pair both = load(w), angle = both * -L_;
        auto [numerator, denominator] = plant_fraction(*this, PairComplex(Pair{}, both));
        const Pair square = norm(denominator);
        if (!ordinary(square) || !in_reach(angle)) return false;
        if (L_ > 0) numerator = product(numerator, unit_circle(angle));
        const PairComplex P = quotient(numerator, denominator, square);
        for (std::size_t i = 0; i < 2; ++i) to[i] = {P.re[i], P.im[i]};
        return true;
    };
    std::vector<std::complex<double>> responses(omega.size());
    in_pairs(
        omega, responses.data(), [this](double w) { return at(std::complex<double>(0, w)); }, pair);
    return responses;
}

int LinearPlant::pole_excess() const {
    return static_cast<int>(poles_.size()) + integrators_ - static_cast<int>(zeros_.size());
}

double LinearPlant::direct_term() const { return pole_excess() == 0 ? gain_ : 0; }

int LinearPlant::unstable_poles() const {
    int count = 0;
    for (const auto pole : poles_) count += pole.real() > kMinRelativeRealPart * std::abs(pole);
    return count;
}

bool LinearPlant::has_right_half_plane_zero() const {
    for (const auto zero : zeros_)
        if (zero.real() > kMinRelativeRealPart * std::abs(zero)) return true;
    return false;
}

double LinearPlant::low_frequency_gain() const {
    std::complex<double> value = gain_;
    for (const auto zero : zeros_) value *= -zero;
    for (const auto pole : poles_) value /= -pole;
    return value.real();
}

double LinearPlant::time_scale() const {
    double time = L_;
    for (const auto pole : poles_) time += 1 / std::abs(pole);
    return time;
}

double LinearPlant::lag_sum() const {
    double sum = 0;
    for (const auto pole : poles_)
        if (pole.real() < 0) sum += (-1.0 / pole).real();
    for (const auto zero : zeros_)
        if (zero.real() < 0) sum -= (-1.0 / zero).real();
    return sum;
}

}  // namespace tunewright
