// The plants of a range's points, with records identified.
#include "engine/request/range/plants_of.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "engine/number_text.h"
#include "engine/range/model/parameters.h"
#include "engine/request/identified_region.h"

namespace tunewright {
namespace {

struct Structure {
    ModelChoice choice;
    const char* name;
    /// true if an identified model has this structure
    bool (*holds)(const Plant& plant);
};

template <class Type>
bool is(const Plant& plant) {
    return std::holds_alternative<Type>(plant);
}

bool is_lagged(const Plant& plant) {
    const auto* ipdt = std::get_if<Ipdt>(&plant);
    return ipdt != nullptr && ipdt->T != 0;
}

constexpr std::array kStructures = {
    Structure{ModelChoice::fopdt, "fopdt", is<Fopdt>},
    Structure{ModelChoice::sopdt, "sopdt", is<Sopdt>},
    Structure{ModelChoice::sopdt_zero, "sopdt_zero", is<TransferFunction>},
    Structure{ModelChoice::ipdt_lag, "ipdt_lag", is_lagged},
    Structure{ModelChoice::ipdt, "ipdt", is<Ipdt>},
};

class Identification {
public:
    Identification(const RangeQuestion& question, const RunControl& control) : question_(question), control_(control) {}

    /// The model of a point's record; `share` of the progress lies before it.
    Expected<IdentifiedModel> model(std::size_t k, const IdentifyOptions& options, double share) const {
        if (control_.progress)
            control_.progress({.fraction = share,
                               .stage = "identify",
                               .message = "Fitting models to the record at " + text(question_.points[k].at) + ".",
                               .best = {}});
        const RunControl quiet{.stop = control_.stop, .progress = {}, .now_ms = {}};
        auto model = identify(std::get<Record>(question_.points[k].content), options, quiet);
        if (model) return model;
        Error error = model.error();
        error.where = "points/" + std::to_string(k) + "/record";
        if (error.kind != ErrorKind::cancelled)
            error.message = "The record at " + question_.scheduling.name + " = " + text(question_.points[k].at) + ": " +
                            error.message;
        return error;
    }

    /// Identifies all records again, in the structure whose total loss is least; keeps the models as they are if no
    /// structure suits all.
    std::optional<Error> in_one_structure(std::vector<RangePointPlant>& plants, std::vector<Warning>& warnings) const {
        const Structure* best = nullptr;
        double min = std::numeric_limits<double>::infinity();
        for (const Structure& structure : kStructures) {
            const double loss = loss_in(structure, plants);
            if (loss < min) {
                min = loss;
                best = &structure;
            }
        }
        if (best == nullptr) return std::nullopt;
        IdentifyOptions options = question_.identify;
        options.model = best->choice;
        std::vector<IdentifiedModel> models;
        for (std::size_t k = 0; k < plants.size(); ++k) {
            if (!plants[k].model || best->holds(plants[k].plant)) continue;
            auto again = model(k, options, 1);
            if (!again) return again.error().kind == ErrorKind::cancelled ? std::optional(again.error()) : std::nullopt;
            models.push_back(std::move(*again));
        }
        std::size_t next = 0;
        for (RangePointPlant& point : plants) {
            if (!point.model || best->holds(point.plant)) continue;
            point.model = std::move(models[next++]);
            point.plant = point.model->plant;
        }
        warnings.push_back({"common-structure",
                            "The records alone would give models of different structure; all were identified as " +
                                std::string(best->name) +
                                ", the structure with the least total loss, so that parameters can be compared from "
                                "point to point. Set identify.model to choose another."});
        return std::nullopt;
    }

private:
    /// The sum of the information criteria; infinite if some point has no such model.
    static double loss_in(const Structure& structure, const std::vector<RangePointPlant>& plants) {
        constexpr double kNone = std::numeric_limits<double>::infinity();
        double sum = 0;
        for (const RangePointPlant& point : plants) {
            if (!point.model) {
                if (!structure.holds(point.plant)) return kNone;
                continue;
            }
            double min = kNone;
            for (const Candidate& candidate : point.model->candidates)
                if (structure.holds(candidate.plant)) min = std::min(min, candidate.criterion);
            sum += min;
        }
        return sum;
    }

    const RangeQuestion& question_;
    const RunControl& control_;
};

bool alike(const std::vector<RangePointPlant>& plants) {
    return std::ranges::all_of(
        plants, [&](const RangePointPlant& point) { return range::same_structure(point.plant, plants.front().plant); });
}

}  // namespace

Expected<std::vector<RangePointPlant>> plants_of(const RangeQuestion& question, const RunControl& control,
                                                 std::vector<range::RangePoint>& points,
                                                 std::vector<Warning>& warnings) {
    const Identification identification(question, control);
    std::vector<RangePointPlant> plants;
    for (std::size_t k = 0; k < question.points.size(); ++k) {
        RangePointPlant point{.at = question.points[k].at, .plant = {}, .model = {}, .u = {}, .y = {}};
        if (const auto* family = std::get_if<PlantFamily>(&question.points[k].content)) {
            point.plant = family->nominal();
        } else {
            auto model = identification.model(k, question.identify, double(k) / double(question.points.size()));
            if (!model) return model.error();
            point.plant = model->plant;
            point.model = std::move(*model);
        }
        plants.push_back(std::move(point));
    }
    if (question.options.between == range::Between::parameters && !alike(plants))
        if (auto error = identification.in_one_structure(plants, warnings)) return *error;

    for (std::size_t k = 0; k < plants.size(); ++k) {
        range::RangePoint point{.at = plants[k].at, .family = family_of(plants[k].plant)};
        if (const auto* family = std::get_if<PlantFamily>(&question.points[k].content)) point.family = *family;
        if (plants[k].model && question.over_region) {
            auto region = identified_region(*plants[k].model);
            if (!region)
                return Error{region.error().kind, "points/" + std::to_string(k) + "/record", region.error().message};
            // A plant of another structure cannot be interpolated between the points.
            region->regions.erase(region->regions.begin() + 1, region->regions.end());
            point.family = std::move(*region);
        }
        points.push_back(std::move(point));
    }
    return plants;
}

}  // namespace tunewright
