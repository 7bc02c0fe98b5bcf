#include "engine/simulation/linear/indices.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kZeroTolerance = 1e-8;  // of a step: length of Newton's last step to a zero; the remaining error is
                                         // its square
constexpr int kMaxIterations = 50;

// Factors instead of divisions: a division takes as long as the rest of the work at a node.
constexpr double kThird = 1.0 / 3, kFifth = 1.0 / 5, kSeventh = 1.0 / 7;

/// c0 + c1 s + c2 s^2 + c3 s^3 over s in [0, 1], through values and slopes at both ends.
struct UnitCubic {
    double c0, c1, c2, c3;

    static UnitCubic through(double h, double a, double slope_a, double b, double slope_b) {
        const double m = slope_a * h, n = slope_b * h, d = b - a;
        return {a, m, 3 * d - 2 * m - n, m + n - 2 * d};
    }
    double at(double s) const { return c0 + s * (c1 + s * (c2 + s * c3)); }
    double slope(double s) const { return c1 + s * (2 * c2 + 3 * s * c3); }
    double integral(double s) const { return s * (c0 + s * (c1 / 2 + s * (c2 * kThird + s * c3 / 4))); }
    /// Integral of s times the cubic.
    double moment(double s) const { return s * s * (c0 / 2 + s * (c1 * kThird + s * (c2 / 4 + s * c3 * kFifth))); }
    /// Integral of its square over [0, 1].
    double square() const {
        return c0 * (c0 + c1) + (c1 * c1 + 2 * c0 * c2 + c2 * c3) * kThird + (c0 * c3 + c1 * c2) / 2 +
               (c2 * c2 + 2 * c1 * c3) * kFifth + c3 * c3 * kSeventh;
    }
    /// True if it certainly rises or falls from end to end, by a bound that needs no roots.
    bool plainly_monotone() const {
        const double rise = c1 + c2 + c3, end = c1 + 2 * c2 + 3 * c3;
        return c1 * rise >= 0 && end * rise >= 0 && std::max(std::abs(c1), std::abs(end)) <= 3 * std::abs(rise);
    }

    /// Points in (0, 1) where the slope changes sign.
    int turning_points(std::array<double, 2>& s) const {
        int count = 0;
        if (plainly_monotone()) return 0;
        const auto keep = [&](double root) {
            if (root > 0 && root < 1) s[Index(count++)] = root;
        };
        const double a = 3 * c3, b = c2, c = c1;
        const double discriminant = b * b - a * c;
        if (discriminant <= 0) return 0;
        const double q = -(b + std::copysign(std::sqrt(discriminant), b));
        if (a != 0) keep(q / a);
        if (q != 0) keep(c / q);
        if (count == 2 && s[0] > s[1]) std::swap(s[0], s[1]);
        return count;
    }

    /// The zero between s = a and s = b, where the signs differ: Newton's method, limited to that interval.
    double zero(double a, double b) const {
        double fa = at(a), s = a - fa * (b - a) / (at(b) - fa);
        for (int i = 0; i < kMaxIterations; ++i) {
            const double f = at(s);
            if ((f < 0) == (fa < 0)) {
                a = s;
                fa = f;
            } else {
                b = s;
            }
            double next = s - f / slope(s);
            if (!(next > a && next < b)) next = 0.5 * (a + b);
            if (std::abs(next - s) < kZeroTolerance) return next;
            s = next;
        }
        return s;
    }
};

UnitCubic cubic_of_y(const ResponseNode& a, const ResponseNode& b) {
    return UnitCubic::through(b.t - a.t, a.y, a.y_slope, b.y, b.y_slope);
}

UnitCubic cubic_of_error(const ResponseNode& a, const ResponseNode& b, double target) {
    return UnitCubic::through(b.t - a.t, target - a.y, -a.y_slope, target - b.y, -b.y_slope);
}

/// Calls piece(s_from, s_to) for the parts of [0, 1] on which the cubic keeps its sign.
template <class Piece>
void signed_pieces(const UnitCubic& e, Piece&& piece) {
    std::array<double, 4> mark{0};
    std::array<double, 2> turns{};
    int n = 1;
    const int turning = e.turning_points(turns);
    for (int i = 0; i < turning; ++i) mark[Index(n++)] = turns[Index(i)];
    mark[Index(n++)] = 1;
    double from = 0;
    for (int i = 1; i < n; ++i) {
        const double fa = e.at(mark[Index(i - 1)]), fb = e.at(mark[Index(i)]);
        if ((fa < 0 && fb > 0) || (fa > 0 && fb < 0)) {
            const double s = e.zero(mark[Index(i - 1)], mark[Index(i)]);
            piece(from, s);
            from = s;
        }
    }
    piece(from, 1.0);
}

bool may_change_sign(const ResponseNode& a, const ResponseNode& b, double target, double h) {
    const double ea = target - a.y, eb = target - b.y;
    if ((ea < 0) != (eb < 0)) return true;
    // The cubic's control values bound it: if all have the same sign, there is no zero.
    const double third = h * kThird, first = ea - a.y_slope * third, second = eb + b.y_slope * third;
    return (first < 0) != (ea < 0) || (second < 0) != (ea < 0);
}

/// The same bound, for a band around the target.
bool stays_within(const ResponseNode& a, const ResponseNode& b, double target, double band, double h) {
    const double third = h * kThird;
    return std::abs(a.y - target) <= band && std::abs(b.y - target) <= band &&
           std::abs(a.y + a.y_slope * third - target) <= band && std::abs(b.y - b.y_slope * third - target) <= band;
}

/// Calls act(SignChange) for each change of the error's sign: without a list, because searches call this thousands of
/// times.
template <class Act>
void for_each_change_of_sign(const std::vector<ResponseNode>& nodes, double target, const Act& act) {
    for (Index i = 1; i < nodes.size(); ++i) {
        const ResponseNode &a = nodes[i - 1], &b = nodes[i];
        const double h = b.t - a.t;
        if (h <= 0) {
            if ((target - a.y < 0) != (target - b.y < 0)) act(SignChange{i, 0});
        } else if (may_change_sign(a, b, target, h)) {
            signed_pieces(cubic_of_error(a, b, target), [&](double, double to) {
                if (to < 1) act(SignChange{i, to});
            });
        }
    }
}

}  // namespace

std::vector<SignChange> changes_of_sign(const std::vector<ResponseNode>& nodes, double target) {
    std::vector<SignChange> changes;
    for_each_change_of_sign(nodes, target, [&](const SignChange& change) { changes.push_back(change); });
    return changes;
}

double change_near(const ResponseNode& a, const ResponseNode& b, double target, double part) {
    constexpr double kMaxZeroCorrection = 0.01;
    const UnitCubic e = cubic_of_error(a, b, target);
    const double step = e.at(part) / e.slope(part);
    return std::abs(step) <= kMaxZeroCorrection ? std::clamp(part - step, 0.0, 1.0) : part;
}

double error_integral_at(const ResponseNode& a, const ResponseNode& b, double target, double part) {
    const UnitCubic e = cubic_of_error(a, b, target);
    const double h = b.t - a.t;
    // From the nearer end, which keeps the interpolation error smallest.
    return part < 0.5 ? a.error_integral + h * e.integral(part)
                      : b.error_integral - h * (e.integral(1) - e.integral(part));
}

double integral_of_absolute_error(const std::vector<ResponseNode>& nodes, double target,
                                  std::optional<double> error_integral_final) {
    double sum = 0, last = 0;  // `last`: the error's integral at the last change of sign
    for_each_change_of_sign(nodes, target, [&](const SignChange& change) {
        const double here = error_integral_at(nodes[change.node - 1], nodes[change.node], target, change.part);
        sum += std::abs(here - last);
        last = here;
    });
    return sum + std::abs(error_integral_final.value_or(nodes.back().error_integral) - last);
}

ErrorIntegrals error_integrals(const std::vector<ResponseNode>& nodes, double target,
                               std::optional<double> error_integral_final) {
    ErrorIntegrals result;
    result.IAE = integral_of_absolute_error(nodes, target, error_integral_final);
    for (Index i = 1; i < nodes.size(); ++i) {
        const ResponseNode &a = nodes[i - 1], &b = nodes[i];
        const double h = b.t - a.t;
        if (h <= 0) continue;
        const UnitCubic e = cubic_of_error(a, b, target);
        result.ISE += h * e.square();
        // The integral of t e from the start of the step, t = a.t + s h.
        const auto first_moment = [&](double s) { return h * (a.t * e.integral(s) + h * e.moment(s)); };
        double so_far = 0;
        const auto add_until = [&](double, double s) {
            const double here = first_moment(s);
            result.ITAE += std::abs(here - so_far);
            so_far = here;
        };
        if (may_change_sign(a, b, target, h))
            signed_pieces(e, add_until);
        else
            add_until(0, 1);
    }
    return result;
}

double total_variation(const std::vector<ResponseNode>& nodes) {
    double sum = nodes.empty() ? 0 : std::abs(nodes.front().u);
    for (Index i = 1; i < nodes.size(); ++i) {
        const ResponseNode &a = nodes[i - 1], &b = nodes[i];
        const double h = b.t - a.t;
        double from = a.u;
        if (h > 0) {
            const UnitCubic u = UnitCubic::through(h, a.u, a.u_slope, b.u, b.u_slope);
            std::array<double, 2> turns{};
            const int n = u.turning_points(turns);
            for (int k = 0; k < n; ++k) {
                const double value = u.at(turns[Index(k)]);
                sum += std::abs(value - from);
                from = value;
            }
        }
        sum += std::abs(b.u - from);
    }
    return sum;
}

namespace {

/// True if y stays within these bounds between two nodes that do, by the cubic's control values.
bool controls_between(const ResponseNode& a, const ResponseNode& b, double min, double max) {
    const double third = (b.t - a.t) * kThird, first = a.y + a.y_slope * third, second = b.y - b.y_slope * third;
    return std::min(first, second) >= min && std::max(first, second) <= max;
}

}  // namespace

Extremes extremes_of_y(const std::vector<ResponseNode>& nodes) {
    Extremes result;
    const auto note = [&](double t, double y) {
        if (y > result.max) {
            result.max = y;
            result.t_max = t;
        }
        if (y < result.min) {
            result.min = y;
            result.t_min = t;
        }
    };
    for (Index i = 0; i < nodes.size(); ++i) {
        note(nodes[i].t, nodes[i].y);
        if (i == 0 || nodes[i].t <= nodes[i - 1].t) continue;
        const ResponseNode &a = nodes[i - 1], &b = nodes[i];
        if (controls_between(a, b, result.min, result.max)) continue;
        const UnitCubic y = cubic_of_y(a, b);
        std::array<double, 2> turns{};
        const int n = y.turning_points(turns);
        for (int k = 0; k < n; ++k) note(a.t + turns[Index(k)] * (b.t - a.t), y.at(turns[Index(k)]));
    }
    return result;
}

std::optional<double> first_reached(const std::vector<ResponseNode>& nodes, double level) {
    const double sign = level < 0 ? -1 : 1;
    for (Index i = 1; i < nodes.size(); ++i) {
        const ResponseNode &a = nodes[i - 1], &b = nodes[i];
        const double h = b.t - a.t;
        if (sign * (a.y - level) >= 0) return a.t;
        if (h <= 0) continue;
        UnitCubic y = cubic_of_y(a, b);
        y.c0 -= level;
        double reached = -1;
        signed_pieces(y, [&](double, double to) {
            if (to < 1 && reached < 0) reached = to;
        });
        if (reached >= 0) return a.t + reached * h;
    }
    return std::nullopt;
}

std::optional<double> last_outside(const std::vector<ResponseNode>& nodes, double target, double band) {
    if (nodes.empty() || std::abs(nodes.back().y - target) > band) return std::nullopt;
    for (Index i = nodes.size() - 1; i > 0; --i) {
        const ResponseNode &a = nodes[i - 1], &b = nodes[i];
        const double h = b.t - a.t;
        if (h <= 0) {
            if (std::abs(a.y - target) > band) return b.t;
            continue;
        }
        if (stays_within(a, b, target, band, h)) continue;
        double last = -1;
        for (const double edge : {target + band, target - band}) {
            UnitCubic y = cubic_of_y(a, b);
            y.c0 -= edge;
            signed_pieces(y, [&](double, double to) {
                if (to < 1) last = std::max(last, to);
            });
        }
        if (last >= 0) return a.t + last * h;
        if (std::abs(a.y - target) > band) return a.t;
    }
    return 0.0;
}

std::vector<std::pair<double, double>> sampled(const std::vector<ResponseNode>& nodes, double horizon, int points) {
    std::vector<std::pair<double, double>> values(static_cast<Index>(points));
    Index at = 0, drawn = nodes.size();  // `drawn`: the node before the cubics
    UnitCubic y{}, u{};
    double inverse = 0;  // 1/time between the two nodes
    for (int i = 0; i < points; ++i) {
        const double t = horizon * i / (points - 1);
        while (at + 1 < nodes.size() && nodes[at + 1].t <= t) ++at;
        const ResponseNode& a = nodes[at];
        auto& value = values[static_cast<Index>(i)];
        if (at + 1 == nodes.size()) {
            value = {a.y, a.u};
            continue;
        }
        if (at != drawn) {
            const ResponseNode& b = nodes[at + 1];
            const double h = b.t - a.t;
            inverse = 1 / h;
            y = cubic_of_y(a, b);
            u = UnitCubic::through(h, a.u, a.u_slope, b.u, b.u_slope);
            drawn = at;
        }
        const double s = (t - a.t) * inverse;
        value = {y.at(s), u.at(s)};
    }
    return values;
}

}  // namespace tunewright
