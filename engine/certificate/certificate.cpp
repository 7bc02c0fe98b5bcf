// Branch and bound, the box with the least bound first:
//
// 1. Take the boxes with the least bounds, up to kBatch, and visit them (box_visit.h), spread over the caller's cores.
// 2. A box that is closed becomes a leaf. One that asks for a sign function gets that of its centre's response, once
//    in a batch, and is visited again. Any other is split in the middle of the unknown that moves the loop most.
// 3. When no box is open, the goal is proven. When the search is stopped, the least bound of an open box is.
//
// The batches and their order do not depend on the cores, so that the result does not either.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <queue>
#include <utility>

#include "engine/certificate/box_visit.h"
#include "engine/certificate/certificate.h"
#include "engine/certificate/design_response.h"

namespace tunewright {
namespace certificate {
namespace {

/// A sign function's mean loses the part of the IAE near the changes of sign, of order 1/harmonics^2. The number is
/// doubled until the design's own mean loses less than this part of the gap, or no sign function could close the gap.
constexpr double kMaxLossOverGap = 0.4;
constexpr int kMinHarmonics = 128, kMaxHarmonics = 2048;
constexpr int kBatch = 32;
constexpr int kMaxSigns = 60;
/// A box of at most this part of the design in k, relative to its own size, may ask for a sign function.
constexpr double kSmallBox = 0.2;
constexpr double kNoGain = 1e-2;  ///< k of a design over its unit: below it the design is an integral alone
constexpr double kGeometric = 8;  ///< a side from l > 0 to more than this multiple of l is split at its geometric mean

struct OpenBox {
    double bound = 0;
    int node = 0, hint = -1;
    bool had_phi = false;
    CertificateLeaf best;  // its best bound, perhaps that of a box around it
};

struct LaterBox {
    bool operator()(const OpenBox& a, const OpenBox& b) const {
        return a.bound != b.bound ? a.bound > b.bound : a.node > b.node;
    }
};

struct TreeNode {
    CertifiedBox box;
    int child = -1;  // the first of two; -1: none
    int leaf = -1;
};

int harmonics_for(const CertificateProblem& problem, const LinearPlant& plant, double half_period, double gap) {
    const auto response = load_response(problem, plant, problem.design, half_period);
    if (!response) return kMinHarmonics;
    const GainsOf<double> design(CertifiedBox{problem.design, problem.design});
    for (int K = kMinHarmonics; K < kMaxHarmonics; K *= 2) {
        const auto a = mean_coefficients(response->sign, jackson_factors(K));
        double mean = 0;
        for (std::size_t m = 0; m < a.size(); ++m) {
            const double w = static_cast<double>(m) * std::numbers::pi / half_period;
            const auto at = point_at(problem, ComplexOf<double>{0.0, w});
            mean += 0.5 * (a[m].low() + a[m].high()) * harmonic_of(terms_at(problem.structure, design, at)).value;
        }
        if (mean >= (1 - kMaxLossOverGap * gap) * response->IAE) return K;
    }
    return kMaxHarmonics;
}

class Search {
public:
    Search(const CertificateProblem& problem, const CertifyOptions& options, const RunControl& control,
           const LinearPlant& plant, const LoadResponse& design, double scale)
        : options_(options),
          control_(control),
          plant_(plant),
          half_period_(std::max(8 / scale, 1.25 * design.time_of_most)),
          harmonics_(harmonics_for(problem, plant, half_period_, options.gap)),
          data_(problem, plant, (1 - options.gap) * problem.upper, scale, std::numbers::pi / half_period_, harmonics_),
          check_(data_.problem, std::numbers::pi / half_period_, harmonics_, data_.edges),
          spaces_(kBatch) {
        result_.problem = problem;
        result_.asked_gap = options.gap;
        result_.goal = data_.goal;
        result_.w0 = std::numbers::pi / half_period_;
        result_.harmonics = harmonics_;
        result_.root = root();
        add_sign(problem.design);
    }

    Certificate run() {
        nodes_.push_back({result_.root, -1, -1});
        open_.push({0, 0, -1, false, {}});
        while (!open_.empty() && result_.boxes < options_.max_boxes && !control_.stop.stop_requested()) {
            take_batch();
            report();
        }
        finish();
        return std::move(result_);
    }

private:
    /// |k| of the design, or what counts as much near the loop's peak if its integral does nearly all.
    double unit_of_k() const {
        return std::max(std::abs(data_.problem.design[0]), data_.problem.design[1] / data_.scale);
    }

    /// The third unknown of the design, or of a usual one if that has no derivative: Td of 0.3 over the frequency of
    /// the largest |S|.
    double unit_of_third() const {
        const CertificateProblem& problem = data_.problem;
        if (problem.structure == CertifiedStructure::pi) return 0;
        const double Td = 0.45 / data_.scale;
        const double usual = problem.structure == CertifiedStructure::pid_tied ? Td : unit_of_k() * Td;
        return problem.design[2] > 0 ? problem.design[2] : usual;
    }

    CertifiedBox root() const {
        const auto& problem = data_.problem;
        const double reach =
            options_.reach.value_or(problem.structure == CertifiedStructure::pi ? kReachOfPi : kReachOfPid);
        // A design with next to no k lies on the edge of the ideal form, whose k and ki have one sign; what lies beyond
        // it may be better, and is no controller of that form.
        const bool at_the_edge = std::abs(problem.design[0]) < kNoGain * unit_of_k();
        CertifiedBox box;
        box.low = {at_the_edge ? 0 : -reach * unit_of_k(), (1 - 1e-9) / data_.goal, 0};
        box.high = {reach * unit_of_k(), std::max(reach * problem.design[1], 1.1 * box.low[1]),
                    reach * unit_of_third()};
        return box;
    }

    /// The sign of the response at these unknowns; false if it promises no more than `needed`.
    bool add_sign(const std::array<double, 3>& unknowns, double needed = 0) {
        if (check_.signs() >= kMaxSigns) return false;
        const auto response = load_response(data_.problem, plant_, unknowns, half_period_);
        if (!response || !(response->IAE > needed)) return false;
        check_.add(response->sign);
        data_.phis.push_back(check_.coefficients(check_.signs() - 1));
        return true;
    }

    static std::array<double, 3> middle(const CertifiedBox& box) {
        std::array<double, 3> at{};
        for (std::size_t i = 0; i < 3; ++i) at[i] = 0.5 * (box.low[i] + box.high[i]);
        return at;
    }

    void take_batch() {
        std::vector<OpenBox> batch;
        while (!open_.empty() && batch.size() < kBatch) {
            batch.push_back(open_.top());
            open_.pop();
        }
        std::vector<BoxOutcome> outcome(batch.size());
        parallel_for(control_.spread, static_cast<int>(batch.size()), [&](int i) {
            const auto at = static_cast<std::size_t>(i);
            const OpenBox& open = batch[at];
            outcome[at] =
                visit_box(data_, check_, nodes_[static_cast<std::size_t>(open.node)].box, open.hint, spaces_[at]);
        });
        bool added = false;
        for (std::size_t i = 0; i < batch.size(); ++i) {
            ++result_.boxes;
            if (outcome[i].closed)
                add_leaf(batch[i].node, std::move(outcome[i].leaf));
            else
                keep_open(batch[i], outcome[i], added);
        }
    }

    void add_leaf(int node, CertificateLeaf leaf) {
        ++result_.leaves_by_reason[static_cast<std::size_t>(leaf.reason)];
        if (!options_.keep_leaves) return;
        nodes_[static_cast<std::size_t>(node)].leaf = static_cast<int>(leaves_.size());
        leaf.box = nodes_[static_cast<std::size_t>(node)].box;
        leaves_.push_back(std::move(leaf));
    }

    void keep_open(OpenBox& open, BoxOutcome& outcome, bool& added) {
        if (outcome.bound > open.bound) {
            open.bound = outcome.bound;
            open.best = std::move(outcome.leaf);
        }
        const CertifiedBox box = nodes_[static_cast<std::size_t>(open.node)].box;
        const bool small = box.high[0] - box.low[0] < 2 * kSmallBox * unit_of_k() &&
                           box.high[1] - box.low[1] < 2 * kSmallBox * data_.problem.design[1];
        if (outcome.wants_phi && small && !open.had_phi && !added && add_sign(middle(box), data_.goal * 1.001)) {
            added = true;
            open.had_phi = true;
            open_.push(std::move(open));
            return;
        }
        split(open, outcome);
    }

    void split(const OpenBox& open, const BoxOutcome& outcome) {
        const CertifiedBox box = nodes_[static_cast<std::size_t>(open.node)].box;
        const auto k = static_cast<std::size_t>(outcome.axis);
        const double low = box.low[k], high = box.high[k];
        const double at = low > 0 && high > kGeometric * low ? std::sqrt(low) * std::sqrt(high) : 0.5 * (low + high);
        const int child = static_cast<int>(nodes_.size());
        nodes_[static_cast<std::size_t>(open.node)].child = child;
        for (int i = 0; i < 2; ++i) {
            CertifiedBox part = box;
            (i == 0 ? part.high : part.low)[k] = at;
            nodes_.push_back({part, -1, -1});
            open_.push({open.bound, child + i, outcome.hint, false, open.best});
        }
    }

    double least_open_bound() const { return open_.empty() ? data_.goal : std::min(open_.top().bound, data_.goal); }

    void report() {
        if (!control_.progress) return;
        result_.lower = std::max(result_.lower, least_open_bound());
        control_.progress({.fraction = std::min(1.0, result_.lower / data_.goal),
                           .stage = "certify",
                           .message = "Proves the bound."});
    }

    void finish() {
        result_.complete = open_.empty();
        result_.lower = data_.goal;
        while (!open_.empty()) {
            OpenBox open = open_.top();
            open_.pop();
            CertificateLeaf leaf = open.best;  // of the box itself or of one around it
            leaf.box = nodes_[static_cast<std::size_t>(open.node)].box;
            result_.lower = std::min(result_.lower, check_.proven_bound(leaf));
            add_leaf(open.node, std::move(leaf));
        }
        result_.gap = (data_.problem.upper - result_.lower) / data_.problem.upper;
        for (int i = 0; i < check_.signs(); ++i) result_.phis.push_back(check_.sign(i));
        if (options_.keep_leaves) collect_leaves();
    }

    /// The leaves of the tree, depth first.
    void collect_leaves() {
        std::vector<int> way = {0};
        while (!way.empty()) {
            const TreeNode& node = nodes_[static_cast<std::size_t>(way.back())];
            way.pop_back();
            if (node.child >= 0) {
                way.push_back(node.child + 1);
                way.push_back(node.child);
            } else if (node.leaf >= 0) {
                result_.leaves.push_back(std::move(leaves_[static_cast<std::size_t>(node.leaf)]));
            }
        }
    }

    const CertifyOptions& options_;
    const RunControl& control_;
    const LinearPlant& plant_;
    double half_period_;
    int harmonics_;
    SearchData data_;
    LeafCheck check_;
    std::vector<VisitSpace> spaces_;
    std::vector<TreeNode> nodes_;
    std::vector<CertificateLeaf> leaves_;
    std::priority_queue<OpenBox, std::vector<OpenBox>, LaterBox> open_;
    Certificate result_;
};

Error wrong(const std::string& where, const std::string& message) {
    return {.kind = ErrorKind::invalid_argument, .where = where, .message = message};
}

std::optional<Error> fault_of(const CertificateProblem& problem, const CertifyOptions& options) {
    if (!(problem.Ms > 1) || !(problem.Mt > 1)) return wrong("Ms", "Ms and Mt must be above 1.");
    if (!(problem.design[1] > 0))
        return wrong("controller", "The design must have integral action of the plant's sign.");
    if (problem.structure == CertifiedStructure::pid_tied && !(problem.design[2] >= 0))
        return wrong("controller", "Td of the design must not be below 0.");
    if (!(problem.upper > 0) || !std::isfinite(problem.upper))
        return wrong("controller", "The design has no finite IAE.");
    if (!(options.gap > 0) || !(options.gap < 1)) return wrong("gap", "The gap must be between 0 and 1.");
    if (options.reach && !(*options.reach > 1)) return wrong("reach", "The reach must be above 1.");
    return std::nullopt;
}

/// Ascending powers times (s - root), for all roots; real, because complex roots come in pairs.
std::vector<double> descending_polynomial(double first, std::span<const std::complex<double>> roots, int at_origin) {
    std::vector<std::complex<double>> a = {first};
    for (const std::complex<double> z : roots) {
        a.emplace_back(0);
        for (std::size_t i = a.size() - 1; i > 0; --i) a[i] -= z * a[i - 1];
    }
    std::vector<double> real;
    for (const auto& x : a) real.push_back(x.real());
    real.resize(real.size() + static_cast<std::size_t>(at_origin), 0.0);
    return real;
}

}  // namespace
}  // namespace certificate

const char* to_string(LeafReason reason) {
    switch (reason) {
        case LeafReason::sensitivity: return "sensitivity";
        case LeafReason::complementary: return "complementary";
        case LeafReason::error: return "error";
        case LeafReason::bound: return "bound";
        case LeafReason::empty: return "empty";
        case LeafReason::unstable: return "unstable";
    }
    return "error";
}

Expected<CertificateProblem> certificate_problem(const LinearPlant& plant, const IdealPid& design, double Ms, double Mt,
                                                 double upper, bool pid) {
    const auto unsupported = [](const std::string& message) {
        return Error{.kind = ErrorKind::unsupported, .where = "controller", .message = message};
    };
    if (plant.integrators() < 0)
        return unsupported("The plant has a zero at s = 0; integral action cannot remove a load.");
    if (!design.has_integral()) return unsupported("The design has no integral action, so its IAE is unbounded.");
    const bool filtered = design.filter.type == FilterType::measurement_second_order;
    if (!filtered && design.filter.type != FilterType::none)
        return unsupported("Only the second-order filter of the measurement is supported.");
    CertificateProblem problem;
    problem.plant = {certificate::descending_polynomial(plant.gain(), plant.zeros(), 0),
                     certificate::descending_polynomial(1, plant.poles(), plant.integrators()), plant.dead_time()};
    problem.Ms = Ms;
    problem.Mt = Mt;
    problem.upper = upper;
    const double sign = design.Kp < 0 ? -1 : 1;
    if (sign < 0)
        for (double& b : problem.plant.num) b = -b;
    problem.design = {sign * design.Kp, sign * design.Kp / design.Ti, 0};
    const double Tf = filtered ? design.filter.Tf : 0;
    const bool no_filter = design.Td == 0 && Tf == 0;
    if (pid && (no_filter || std::abs(Tf * certificate::kN - design.Td) < 1e-9 * design.Td)) {
        problem.structure = CertifiedStructure::pid_tied;
        problem.design[2] = design.Td;
    } else {
        problem.Tf = Tf;
        problem.structure = pid ? CertifiedStructure::pid_fixed : CertifiedStructure::pi;
        problem.design[2] = sign * design.Kp * design.Td;
    }
    return problem;
}

Expected<Certificate> certify(const CertificateProblem& problem, const CertifyOptions& options,
                              const RunControl& control) {
    if (const auto fault = certificate::fault_of(problem, options)) return *fault;
    const auto plant = LinearPlant::make(TransferFunction{problem.plant.num, problem.plant.den, problem.plant.L, {}});
    if (!plant) return plant.error();
    const auto design = certificate::load_response(problem, *plant, problem.design, 0);
    if (!design) return certificate::wrong("controller", "The design is not stable, or its response does not settle.");
    const double scale = certificate::frequency_scale(problem, std::max(plant->time_scale(), 1e-300));
    return certificate::Search(problem, options, control, *plant, *design, scale).run();
}

}  // namespace tunewright
