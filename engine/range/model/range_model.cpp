#include "engine/range/model/range_model.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <utility>

#include "engine/number_text.h"
#include "engine/range/equations/steady_branch.h"
#include "engine/range/model/parameters.h"
#include "engine/tuning/robust/filter_rule.h"

namespace tunewright::range {
namespace {

constexpr int kResponsePoints = 160;
constexpr double kBelowCorners = 1e-2;  // multiple of the slowest corner: frequency at which the static gain is read
constexpr double kMaxDelayTurns = 4;    // turns of the dead time: higher frequencies no longer limit the gain

std::string point_name(std::size_t k) { return "points/" + std::to_string(k); }

Error at_point(std::size_t k, const std::string& field, std::string message, ErrorKind kind) {
    return {kind, point_name(k) + "/" + field, std::move(message)};
}

Error bad_point(std::size_t k, const std::string& field, std::string message) {
    return at_point(k, field, std::move(message), ErrorKind::invalid_argument);
}

std::optional<Error> fault_of_points(const std::vector<RangePoint>& points) {
    std::vector<double> places;
    for (const RangePoint& point : points) places.push_back(point.at);
    if (auto faults = place_faults(places); !faults.empty()) return faults.front();
    for (std::size_t k = 0; k < points.size(); ++k)
        if (points[k].family.regions.empty()) return bad_point(k, "plant", "The point has no plant.");
    return std::nullopt;
}

/// The data that all models of points share: the points themselves, checked and factored.
class PointsModel : public RangeModel {
public:
    Expected<PointModel> at(double place) const final {
        const auto after = std::upper_bound(points_.begin() + 1, points_.end() - 1, place);
        const auto left = std::size_t(after - points_.begin()) - 1;
        const double share = std::clamp((place - points_[left]) / (points_[left + 1] - points_[left]), 0.0, 1.0);
        if (share == 0 || share == 1) return models_[share == 0 ? left : left + 1];
        return between(left, share, place);
    }

protected:
    /// The plant at `place`, `share` in (0, 1) of the way from the point `left` to the next.
    virtual Expected<PointModel> between(std::size_t left, double share, double place) const = 0;

    std::optional<Error> take(const std::vector<RangePoint>& points) {
        if (auto fault = fault_of_points(points)) return fault;
        given_ = points;
        for (std::size_t k = 0; k < points.size(); ++k) {
            auto made = model_at_point(k);
            if (!made) return at_point(k, "plant", made.error().message, made.error().kind);
            if (k > 0 && robust::first_sign(*made->nominal) != robust::first_sign(*models_.back().nominal))
                return at_point(k, "plant",
                                "The gain changes its sign between " + text(points[k - 1].at) + " and " +
                                    text(points[k].at) +
                                    ", so between them the input does not move the output, and no controller with one "
                                    "sign is stable at both. Split the range there.",
                                ErrorKind::no_feasible_controller);
            models_.push_back(std::move(*made));
            points_.push_back(points[k].at);
        }
        low_ = points_.front();
        high_ = points_.back();
        return std::nullopt;
    }

    Expected<PointModel> model_at_point(std::size_t k) const {
        const PlantFamily& family = given_[k].family;
        auto nominal = LinearPlant::make(family.nominal());
        if (!nominal) return nominal.error();
        PointModel model{.at = given_[k].at, .nominal = std::move(*nominal), .members = {}, .measured = {}};
        for (const Plant& member : members_without_nominal(family)) {
            auto linear = LinearPlant::make(member);
            if (!linear) return linear.error();
            model.members.push_back(std::move(*linear));
        }
        if (!family.single()) model.family = family;
        return model;
    }

    std::vector<RangePoint> given_;
    std::vector<PointModel> models_;
};

using LogRatios = std::vector<double>;

/// The cosine of the angle between two deviations from the nominal plants.
double alike(const LogRatios& a, const LogRatios& b) {
    double ab = 0, aa = 1e-300, bb = 1e-300;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += a[i] * b[i];
        aa += a[i] * a[i];
        bb += b[i] * b[i];
    }
    return ab / std::sqrt(aa * bb);
}

/// True if some number is above its nominal value in one and below in the other.
bool opposed(const LogRatios& a, const LogRatios& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i] * b[i] < 0) return true;
    return false;
}

/// True if `a` lies between its nominal plant and the other member, `b`.
bool inside(const LogRatios& a, const LogRatios& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        if (std::abs(a[i]) > std::abs(b[i])) return false;
    return a != b && !opposed(a, b);
}

std::vector<LogRatios> outermost(const std::vector<LogRatios>& members) {
    std::vector<LogRatios> result;
    for (const LogRatios& member : members)
        if (std::ranges::none_of(members, [&](const LogRatios& other) { return inside(member, other); }))
            result.push_back(member);
    return result;
}

bool uncertain_in(const std::vector<LogRatios>& members, std::size_t number) {
    return std::ranges::any_of(members, [&](const LogRatios& member) { return member[number] != 0; });
}

/// Pairs each member of one family with the member of the other whose deviation from its nominal plant is most similar;
/// a family without members contributes its nominal plant. If a number is uncertain in one family only, similarity
/// cannot decide: then all outermost members of both that are not opposed are paired too, so that the plants between
/// are enclosed.
std::vector<std::pair<LogRatios, LogRatios>> paired(const std::vector<LogRatios>& left,
                                                    const std::vector<LogRatios>& right, std::size_t size) {
    std::vector<std::pair<LogRatios, LogRatios>> pairs;
    const auto best_match = [&](const std::vector<LogRatios>& others, const LogRatios& member) {
        if (others.empty()) return LogRatios(size, 0.0);
        return *std::ranges::max_element(others, {}, [&](const LogRatios& other) { return alike(other, member); });
    };
    for (const LogRatios& member : left) pairs.emplace_back(member, best_match(right, member));
    for (const LogRatios& member : right) pairs.emplace_back(best_match(left, member), member);
    bool unlike = false;
    for (std::size_t i = 0; i < size; ++i) unlike = unlike || uncertain_in(left, i) != uncertain_in(right, i);
    if (unlike)
        for (const LogRatios& a : outermost(left))
            for (const LogRatios& b : outermost(right))
                if (!opposed(a, b)) pairs.emplace_back(a, b);
    std::ranges::sort(pairs);
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

class ParametersModel : public PointsModel {
public:
    std::optional<Error> make(const std::vector<RangePoint>& points) {
        if (auto fault = take(points)) return fault;
        for (std::size_t k = 1; k < points.size(); ++k)
            if (auto fault = fault_between(points[k - 1], points[k])) return bad_point(k, "plant", *fault);
        for (std::size_t k = 0; k + 1 < points.size(); ++k)
            pairs_.push_back(paired(ratios(points[k].family), ratios(points[k + 1].family),
                                    structure_numbers(points[k].family.nominal()).size()));
        stated_ =
            "Between the points the logarithms of the parameters (gain, time constants, dead time) are linear in the "
            "scheduling variable; a parameter of either sign, or 0 at one end, is linear itself.";
        return std::nullopt;
    }

    Expected<PointModel> between(std::size_t left, double share, double place) const override {
        const PlantFamily &one = given_[left].family, &other = given_[left + 1].family;
        const Plant plant = plant_between(one.nominal(), other.nominal(), share);
        auto nominal = LinearPlant::make(plant);
        if (!nominal) return nominal.error();
        PointModel model{.at = place, .nominal = std::move(*nominal), .members = {}, .measured = {}};
        for (const auto& [a, b] : pairs_[left]) {
            LogRatios ratios(a.size());
            for (std::size_t i = 0; i < a.size(); ++i) ratios[i] = a[i] + share * (b[i] - a[i]);
            auto linear = LinearPlant::make(moved_by(plant, ratios));
            if (linear) model.members.push_back(std::move(*linear));
        }
        return model;
    }

private:
    /// The reason why two points cannot be interpolated.
    static std::optional<std::string> fault_between(const RangePoint& left, const RangePoint& right) {
        const Plant &one = left.family.nominal(), &other = right.family.nominal();
        const std::string places = text(left.at) + " and " + text(right.at);
        const std::string cure =
            " Give both in one structure of named parameters or coefficients, or set "
            "schedule.between to \"frequency_response\".";
        if (one.index() == other.index() && structure_numbers(one).empty())
            return "The plants at " + places +
                   " are given by zeros and poles or as state spaces, whose numbers are not interpolated." + cure;
        if (!same_structure(one, other))
            return "The plants at " + places + " differ in structure, so their parameters cannot be interpolated." +
                   cure;
        const auto* rational = std::get_if<TransferFunction>(&one);
        const double a = structure_numbers(one).front(), b = structure_numbers(other).front();
        if ((rational != nullptr && rational->num.size() > 1) || a * b > 0) return std::nullopt;
        return "The plant's " + std::string(rational != nullptr ? "numerator" : "K") + " goes from " + text(a) +
               " to " + text(b) + " between " + places +
               "; where it is 0 the input does not move the output. Split the range there.";
    }

    /// Only members with the nominal plant's structure: others cannot be interpolated.
    static std::vector<LogRatios> ratios(const PlantFamily& family) {
        std::vector<LogRatios> result;
        for (const Plant& member : members_without_nominal(family))
            if (same_structure(member, family.nominal())) result.push_back(log_ratios(family.nominal(), member));
        return result;
    }

    std::vector<std::vector<std::pair<LogRatios, LogRatios>>> pairs_;  // pairs of each two neighbours
};

/// ln |P| and the unwrapped phase at the model's frequencies.
struct ResponseCurve {
    std::vector<double> log_size, phase;
};

class ResponsesModel : public PointsModel {
public:
    std::optional<Error> make(const std::vector<RangePoint>& points) {
        if (auto fault = take(points)) return fault;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const LinearPlant &plant = *models_[k].nominal, &first = *models_[0].nominal;
            if (!points[k].family.single())
                return bad_point(k, "plant",
                                 "Frequency responses have no uncertain parameters, so the uncertainty cannot be "
                                 "interpolated. Interpolate the parameters, or omit the uncertainty.");
            if (plant.integrators() != first.integrators() || plant.unstable_poles() != first.unstable_poles())
                return bad_point(k, "plant",
                                 "The plant has " + std::to_string(plant.integrators()) + " integrators and " +
                                     std::to_string(plant.unstable_poles()) + " unstable poles, the first one " +
                                     std::to_string(first.integrators()) + " and " +
                                     std::to_string(first.unstable_poles()) +
                                     ", so their frequency responses cannot be interpolated. Split the range where "
                                     "that number changes.");
        }
        has_responses_ = false;
        choose_frequencies();
        for (const PointModel& model : models_) curves_.push_back(curve(*model.nominal));
        stated_ =
            "Between the points the logarithm of |P| and the unwrapped phase are linear in the scheduling variable; "
            "such a plant has no response over time, so Ti/Kp is used in place of the IAE over the range.";
        return std::nullopt;
    }

    Expected<PointModel> between(std::size_t left, double share, double place) const override {
        FrequencyResponse response{.omega = omega_,
                                   .re = {},
                                   .im = {},
                                   .unstable_poles = models_[0].nominal->unstable_poles(),
                                   .integrators = models_[0].nominal->integrators()};
        const ResponseCurve &one = curves_[left], &other = curves_[left + 1];
        for (std::size_t i = 0; i < omega_.size(); ++i) {
            const double phase = one.phase[i] + share * (other.phase[i] - one.phase[i]);
            const auto value =
                std::polar(std::exp(one.log_size[i] + share * (other.log_size[i] - one.log_size[i])), phase);
            response.re.push_back(value.real());
            response.im.push_back(value.imag());
        }
        auto measured = MeasuredPlant::make(response);
        if (!measured) return measured.error();
        return PointModel{.at = place, .nominal = {}, .members = {}, .measured = std::move(*measured)};
    }

private:
    void choose_frequencies() {
        double slowest = INFINITY, fastest = 0, longest = 0;
        const auto note = [&](double corner) {
            if (!(corner > 0)) return;
            slowest = std::min(slowest, corner);
            fastest = std::max(fastest, corner);
        };
        for (const PointModel& model : models_) {
            for (const auto pole : model.nominal->poles()) note(std::abs(pole));
            for (const auto zero : model.nominal->zeros()) note(std::abs(zero));
            const double L = model.nominal->dead_time();
            if (L > 0) note(1 / L);
            longest = std::max(longest, L);
        }
        if (!(fastest > 0)) slowest = fastest = 1;
        const double low = kBelowCorners * slowest;
        double high = 100 * fastest;
        if (longest > 0) high = std::max(10 * slowest, std::min(high, kMaxDelayTurns * 2 * std::numbers::pi / longest));
        for (int i = 0; i < kResponsePoints; ++i)
            omega_.push_back(low * std::pow(high / low, double(i) / (kResponsePoints - 1)));
    }

    ResponseCurve curve(const LinearPlant& plant) {
        ResponseCurve result;
        double before = 0;
        for (const double omega : omega_) {
            const std::complex<double> value = plant.rational({0, omega});
            const double wrapped = std::arg(value);
            // Makes the first phase close to that of the previous model, so that two values above and below the
            // negative real axis do not differ by a turn; the dead time's part is known without unwrapping.
            if (result.phase.empty()) before = curves_.empty() ? wrapped : first_phase_;
            const double unwrapped = before + std::remainder(wrapped - before, 2 * std::numbers::pi);
            if (result.phase.empty()) first_phase_ = unwrapped;
            before = unwrapped;
            result.log_size.push_back(std::log(std::abs(value)));
            result.phase.push_back(unwrapped - omega * plant.dead_time());
        }
        return result;
    }

    std::vector<double> omega_;
    std::vector<ResponseCurve> curves_;
    double first_phase_ = 0;  // at the lowest frequency of the previous model
};

template <class Model>
Expected<std::shared_ptr<const RangeModel>> made(const std::vector<RangePoint>& points) {
    auto model = std::make_shared<Model>();
    if (auto fault = model->make(points)) return *fault;
    return std::shared_ptr<const RangeModel>(std::move(model));
}

}  // namespace

std::vector<Error> place_faults(const std::vector<double>& places) {
    if (places.size() < std::size_t(kFewestPoints) || places.size() > std::size_t(kMaxPoints))
        return {{ErrorKind::invalid_argument, "points",
                 "There are " + std::to_string(places.size()) + " points; give 2 to 20."}};
    std::vector<Error> faults;
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (!std::isfinite(places[k])) {
            faults.push_back(bad_point(k, "at", "at is not a finite number."));
        } else if (k > 0 && !(places[k] > places[k - 1])) {
            faults.push_back(bad_point(k, "at",
                                       "at is " + text(places[k]) + " after " + text(places[k - 1]) +
                                           "; the points must be in ascending order, each place once. Sort them, and "
                                           "keep one of those at the same place."));
        }
    }
    return faults;
}

Expected<std::shared_ptr<const RangeModel>> model_of_points(const std::vector<RangePoint>& points, Between between) {
    return between == Between::parameters ? made<ParametersModel>(points) : made<ResponsesModel>(points);
}

namespace {

constexpr int kPoints = 5;

class BranchModel : public RangeModel {
public:
    explicit BranchModel(std::shared_ptr<const SteadyBranch> branch) : branch_(std::move(branch)) {
        low_ = branch_->low();
        high_ = branch_->high();
        for (int k = 0; k < kPoints; ++k) points_.push_back(low_ + (high_ - low_) * k / (kPoints - 1));
        points_.back() = high_;
        stated_ =
            "At every place the plant is the exact linearisation of the equations about their steady state there.";
        for (const Fold& fold : branch_->input_folds())
            warnings_.push_back(
                {"input-folds",
                 "Along the steady states the input has a turning point at " + branch_->scheduling_name() + " = " +
                     text(fold.state.at, 6) + " (" + branch_->range().plant.input.name + " = " + text(fold.state.u, 6) +
                     "): on one side of it the plant has a pole in the right half-plane and only feedback holds it."});
    }

    Expected<PointModel> at(double place) const override {
        const auto state = branch_->at(place);
        if (!state) return state.error();
        auto linear = LinearPlant::make(branch_->linearised(*state));
        if (!linear)
            return Error{linear.error().kind, "plant/equations",
                         "The linearisation at " + branch_->scheduling_name() + " = " + text(place, 6) +
                             " is not supported. " + linear.error().message};
        PointModel model{.at = place, .nominal = std::move(*linear), .members = {}, .measured = {}};
        model.u = state->u;
        model.y = state->y;
        return model;
    }

private:
    std::shared_ptr<const SteadyBranch> branch_;
};

}  // namespace

Expected<std::shared_ptr<const RangeModel>> model_of_branch(std::shared_ptr<const SteadyBranch> branch) {
    std::shared_ptr<const RangeModel> model = std::make_shared<BranchModel>(std::move(branch));
    for (const double at : model->points())
        if (const auto place = model->at(at); !place) return place.error();
    return model;
}

}  // namespace tunewright::range
