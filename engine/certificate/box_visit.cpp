#include "engine/certificate/box_visit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "engine/certificate/design_response.h"
#include "engine/loop/stability.h"

namespace tunewright::certificate {
namespace {

/// Above the rounding of the search, so that the check over intervals seldom fails.
constexpr double kSurplus = 1e-9;
/// A centre whose bound is below this multiple of the goal asks for a sign function of its own.
constexpr double kNearGoal = 1.02;
/// The grid of the right half-plane, in multiples of the scale: real parts, and the number of imaginary parts.
constexpr std::array<double, 11> kAcross = {0.02, 0.05, 0.1, 0.2, 0.35, 0.6, 1.0, 1.7, 3.0, 6.0, 12.0};
constexpr int kAlong = 48;

class Visit {
public:
    Visit(const SearchData& data, const LeafCheck& check, const CertifiedBox& box, VisitSpace& space)
        : data_(data), check_(check), box_(box), gains_(box), space_(space) {
        outcome_.leaf.box = box;
    }

    BoxOutcome run(int hint) {
        if (by_error({0, 0}, 1 / box_.high[1]) || (hint >= 0 && by_frequency(static_cast<std::size_t>(hint))) ||
            by_frequencies() || by_right_half_plane())
            return outcome_;
        choose_axis();
        if (!centre_unstable_) by_phi();
        return outcome_;
    }

private:
    TermsOf<double> terms(const PointOf<double>& at) const { return terms_at(data_.problem.structure, gains_, at); }

    bool close(const CertificateLeaf& leaf) {
        if (!(check_.proven_bound(leaf) >= data_.goal)) return false;
        outcome_.leaf = leaf;
        outcome_.closed = true;
        return true;
    }

    void note_bound(const CertificateLeaf& leaf, double bound) {
        if (!(bound > outcome_.bound)) return;
        outcome_.bound = bound;
        outcome_.leaf = leaf;
    }

    bool by_error(std::complex<double> s, double bound) {
        CertificateLeaf leaf{.box = box_, .reason = LeafReason::error, .omega = 0, .s = s, .phi = 0, .cuts = {}};
        if (bound > data_.goal * (1 + kSurplus) && close(leaf)) return true;
        note_bound(leaf, bound);
        return false;
    }

    bool by_limit(bool complementary, std::size_t i) {
        CertificateLeaf leaf;
        leaf.box = box_;
        leaf.reason = complementary ? LeafReason::complementary : LeafReason::sensitivity;
        leaf.omega = data_.pieces[i].centre;
        return close(leaf);
    }

    bool by_frequency(std::size_t i) {
        const auto at = terms(data_.pieces[i].point);
        for (const bool complementary : {false, true}) {
            const auto& disc = data_.discs[2 * i + (complementary ? 1 : 0)];
            if (largest_size(at, disc.shift) < disc.radius * (1 - kSurplus) && by_limit(complementary, i)) return true;
        }
        return by_error({0, data_.pieces[i].centre}, error_bound(at));
    }

    bool by_frequencies() {
        double nearest = std::numeric_limits<double>::infinity();
        space_.axis.resize(data_.pieces.size());
        for (std::size_t i = 0; i < data_.pieces.size(); ++i) {
            const auto& at = space_.axis[i] = terms(data_.pieces[i].point);
            for (const bool complementary : {false, true}) {
                const auto& disc = data_.discs[2 * i + (complementary ? 1 : 0)];
                const double ratio = largest_size(at, disc.shift) / disc.radius;
                if (ratio < 1 - kSurplus && by_limit(complementary, i)) return true;
                if (ratio < nearest) {
                    nearest = ratio;
                    outcome_.hint = static_cast<int>(i);
                }
            }
            const double bound = error_bound(at);
            if (bound > outcome_.bound && by_error({0, data_.pieces[i].centre}, bound)) return true;
        }
        return false;
    }

    bool by_right_half_plane() {
        std::vector<double> ratio;  // |1 + L|^2 of the centre
        for (const auto& at : data_.right) {
            const auto value = terms(at);
            const double bound = error_bound(value);
            if (bound > outcome_.bound && by_error({at.s.re, at.s.im}, bound)) return true;
            ratio.push_back(norm(value.centre) / norm(at.Q));
        }
        for (const std::size_t start : lowest_of(ratio)) {
            const auto& at = data_.right[start];
            if (by_pole_near({at.s.re, at.s.im})) return true;
        }
        return !centre_unstable_ && by_rightmost_pole();
    }

    bool by_pole_near(std::complex<double> start) {
        const auto pole = pole_near(start);
        if (!pole) return false;
        centre_unstable_ = true;
        const auto at = point_at(data_.problem, ComplexOf<double>{pole->real(), pole->imag()});
        return by_error(*pole, error_bound(terms(at))) || by_whole_axis(*pole);
    }

    /// Without it a box around an unstable centre whose pole the grid misses would be split again and again.
    bool by_rightmost_pole() {
        const auto loop = Loop::make(*data_.plant, controller_at(data_.problem, gains_.c));
        if (!loop || count_unstable_poles(*loop).stable()) return false;
        const auto pole = rightmost_pole(*loop);
        return pole && by_pole_near(*pole);
    }

    /// The local minima over the grid of the right half-plane, the lowest first: poles are near some of them.
    static std::vector<std::size_t> lowest_of(const std::vector<double>& ratio) {
        constexpr std::size_t kStarts = 5;
        constexpr int kRows = static_cast<int>(kAcross.size());
        std::vector<std::pair<double, std::size_t>> lowest;
        for (int i = 0; i < kRows; ++i)
            for (int k = 0; k < kAlong; ++k) {
                const auto value = [&](int row, int column) {
                    return ratio[static_cast<std::size_t>(row * kAlong + column)];
                };
                bool low = true;
                for (int u = std::max(i - 1, 0); u <= std::min(i + 1, kRows - 1); ++u)
                    for (int v = std::max(k - 1, 0); v <= std::min(k + 1, kAlong - 1); ++v)
                        low &= value(i, k) <= value(u, v);
                if (low) lowest.emplace_back(value(i, k), static_cast<std::size_t>(i * kAlong + k));
            }
        std::sort(lowest.begin(), lowest.end());
        std::vector<std::size_t> starts;
        for (std::size_t i = 0; i < std::min(kStarts, lowest.size()); ++i) starts.push_back(lowest[i].second);
        return starts;
    }

    std::complex<double> D(std::complex<double> s) const {
        GainsOf<double> centre = gains_;
        centre.h = {};
        const auto z =
            terms_at(data_.problem.structure, centre, point_at(data_.problem, ComplexOf<double>{s.real(), s.imag()}))
                .centre;
        return {z.re, z.im};
    }

    /// A zero of D of the centre in the right half-plane, by Newton's method.
    std::optional<std::complex<double>> pole_near(std::complex<double> s) const {
        for (int i = 0; i < 10; ++i) {
            const double e = 1e-6 * (std::abs(s) + 1e-3 * data_.scale);
            const auto value = D(s), slope = (D(s + e) - value) / e;
            auto step = value / slope;
            if (!(std::abs(step) < 1e300)) return std::nullopt;
            if (std::abs(step) > 0.5 * std::abs(s)) step *= 0.5 * std::abs(s) / std::abs(step);
            s -= step;
            if (std::abs(step) < 1e-12 * std::abs(s)) break;
        }
        const auto at = point_at(data_.problem, ComplexOf<double>{s.real(), s.imag()});
        if (!(s.real() > 1e-9 * data_.scale) || !(std::abs(D(s)) < 1e-8 * (size(at.Q) + gains_.c[1])))
            return std::nullopt;
        return s;
    }

    bool by_whole_axis(std::complex<double> pole) {
        const double needed = std::abs(D(pole)) * 2;
        for (std::size_t i = 0; i < data_.pieces.size(); ++i) {
            if (!(least_size(data_.problem, gains_, data_.pieces[i], space_.axis[i]) > needed)) return false;
            if (least_size_beyond(data_.problem, gains_, data_.edges[i + 1]) > needed) break;
        }
        CertificateLeaf leaf;
        leaf.box = box_;
        leaf.reason = LeafReason::unstable;
        leaf.s = pole;
        return close(leaf);
    }

    /// The unknown whose half-width moves D most, relative to it, around the loop's peak.
    void choose_axis() {
        std::array<double, 3> weight{};
        for (const double w : {0.2, 0.6, 1.5}) {
            const auto above = std::lower_bound(data_.edges.begin() + 1, data_.edges.end() - 1, w * data_.scale);
            const auto i = static_cast<std::size_t>(above - data_.edges.begin()) - 1;
            const auto& at = space_.axis[i];
            const double far = size(data_.pieces[i].point.Q) + size(at.centre);
            for (std::size_t k = 0; k < 3; ++k) weight[k] += size(at.g[k]) / far;
            if (data_.problem.structure == CertifiedStructure::pid_tied && size(at.g[2]) == 0)
                weight[2] += at.rest / far;
        }
        for (int k = 0; k < data_.unknowns(); ++k)
            if (weight[static_cast<std::size_t>(k)] > weight[static_cast<std::size_t>(outcome_.axis)])
                outcome_.axis = k;
    }

    bool by_phi() {
        space_.harmonic.clear();
        for (const auto& at : data_.harmonic) {
            space_.harmonic.push_back(harmonic_of(terms(at)));
            if (!space_.harmonic.back().exists) return false;
        }
        std::size_t best = 0;
        double best_bound = -std::numeric_limits<double>::infinity(), best_value = 0;
        for (std::size_t phi = 0; phi < data_.phis.size(); ++phi) {
            double value = 0, rest = 0;
            for (std::size_t m = 0; m < space_.harmonic.size(); ++m) {
                value += data_.phis[phi][m] * space_.harmonic[m].value;
                rest += std::abs(data_.phis[phi][m]) * space_.harmonic[m].rest;
            }
            best_value = std::max(best_value, value);
            if (value - rest > best_bound) {
                best_bound = value - rest;
                best = phi;
            }
        }
        outcome_.wants_phi = best_value < kNearGoal * data_.goal;
        std::array<double, 3> slope{};
        for (std::size_t m = 0; m < space_.harmonic.size(); ++m)
            for (std::size_t i = 0; i < 3; ++i) slope[i] += data_.phis[best][m] * space_.harmonic[m].slope[i];
        return by_program(static_cast<int>(best), best_bound, slope);
    }

    bool by_program(int phi, double bound, const std::array<double, 3>& slope) {
        collect_rows();
        const auto solved = solve_small_program(data_.unknowns(), slope, space_.rows);
        CertificateLeaf leaf;
        leaf.box = box_;
        leaf.phi = phi;
        for (const auto& [row, multiplier] : solved.multipliers) {
            leaf.cuts.push_back(space_.cuts[static_cast<std::size_t>(row)]);
            leaf.cuts.back().multiplier = multiplier * scale_[static_cast<std::size_t>(row)];
        }
        if (solved.kind == ProgramResult::Kind::empty) {
            leaf.reason = LeafReason::empty;
            return close(leaf);
        }
        if (solved.kind != ProgramResult::Kind::solved) return false;
        leaf.reason = LeafReason::bound;
        bound += solved.least;
        if (bound > data_.goal * (1 + kSurplus) && close(leaf)) return true;
        note_bound(leaf, bound);
        return false;
    }

    /// The half-planes that cut the box.
    void collect_rows() {
        space_.rows.clear();
        space_.cuts.clear();
        for (std::size_t i = 0; i < data_.pieces.size(); ++i) {
            for (const bool complementary : {false, true}) {
                const auto plane = half_plane(space_.axis[i], data_.discs[2 * i + (complementary ? 1 : 0)]);
                if (!plane.exists) continue;
                const double reach = std::abs(plane.row[0]) + std::abs(plane.row[1]) + std::abs(plane.row[2]);
                if (plane.least < -reach) continue;
                // Rows of one size, so that violations can be compared.
                const double unit = 1 / reach;
                space_.rows.push_back(
                    {{plane.row[0] * unit, plane.row[1] * unit, plane.row[2] * unit}, plane.least * unit});
                space_.cuts.push_back({complementary, data_.pieces[i].centre, 0});
                scale_.push_back(unit);
            }
        }
    }

    const SearchData& data_;
    const LeafCheck& check_;
    const CertifiedBox& box_;
    GainsOf<double> gains_;
    VisitSpace& space_;
    BoxOutcome outcome_;
    bool centre_unstable_ = false;
    std::vector<double> scale_;  // of each row
};

}  // namespace

SearchData::SearchData(const CertificateProblem& of, const LinearPlant& plant_, double goal_, double scale_, double w0,
                       int harmonics)
    : problem(of), plant(&plant_), goal(goal_), scale(scale_), edges(axis_edges(scale_)) {
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        pieces.push_back(axis_piece<double>(problem, 0.5 * (edges[i] + edges[i + 1]), 0.5 * (edges[i + 1] - edges[i])));
        for (const bool complementary : {false, true})
            discs.push_back(forbidden_disc(problem, pieces.back().point, complementary));
    }
    for (const double re : kAcross)
        for (int i = 0; i < kAlong; ++i) {
            const double im = i == 0 ? 0 : std::pow(10.0, -2 + 3.6 * (i - 1) / (kAlong - 2));
            right.push_back(point_at(problem, ComplexOf<double>{re * scale, im * scale}));
        }
    for (int m = 0; m < harmonics; ++m) harmonic.push_back(point_at(problem, ComplexOf<double>{0.0, m * w0}));
}

BoxOutcome visit_box(const SearchData& data, const LeafCheck& check, const CertifiedBox& box, int hint,
                     VisitSpace& space) {
    return Visit(data, check, box, space).run(hint);
}

}  // namespace tunewright::certificate
