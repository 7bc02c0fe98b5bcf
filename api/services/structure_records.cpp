#include "api/services/structure_records.h"

#include <algorithm>
#include <utility>

namespace tunewright::api {
namespace {

std::optional<Error> make_plant(const Plant& model, const std::string& where, std::optional<LinearPlant>& out) {
    auto plant = LinearPlant::make(model);
    if (!plant) return Error{plant.error().kind, where, plant.error().message};
    out = std::move(*plant);
    return std::nullopt;
}

const DisturbanceModel* further_input(const IdentifiedModel& model, const std::string& name) {
    const auto found = std::ranges::find(model.disturbances, name, &DisturbanceModel::name);
    return found == model.disturbances.end() ? nullptr : &*found;
}

/// "The inner plant: ", if one record stands for several plants that are identified one by one.
std::string named(const NamedRecord& one, const StructureRequest& request) {
    const auto shares = [&](const NamedRecord& other) { return other.where == one.where; };
    return std::ranges::count_if(request.records, shares) > 1 ? "The " + one.name + " plant: " : "";
}

/// The places of the plants that a record stands for.
std::vector<std::string> plants_of(const NamedRecord& one) {
    if (one.name == "inner" || one.name == "outer") return {one.name + "/plant"};
    if (one.where == "record") return {"plant", "disturbance"};
    return {"plant" + one.where.substr(one.where.find('/'))};
}

}  // namespace

Error at_source(Error error, const StructureRequest& request) {
    for (const NamedRecord& one : request.records)
        for (const std::string& plant : plants_of(one))
            if (error.where == plant || error.where.starts_with(plant + "/")) {
                error.where = one.where;
                return error;
            }
    if (error.where == "plant" && !request.records.empty()) error.where = "records";
    return error;
}

Expected<std::vector<NamedModel>> models_of(const StructureRequest& request, const RunControl& control) {
    std::vector<NamedModel> out;
    for (const NamedRecord& one : request.records) {
        auto model = identify(one.read.record, {}, control);
        if (!model) return Error{model.error().kind, one.where, named(one, request) + model.error().message};
        add_reading(one.read, *model);
        leave_out_traces({}, *model);
        out.push_back({one.name, std::move(*model)});
    }
    return out;
}

std::optional<Error> take_models(const std::vector<NamedModel>& models, CascadeRequest& request) {
    for (const NamedModel& one : models) {
        auto& plant = one.name == "inner" ? request.inner.plant : request.outer.plant;
        const auto record = std::ranges::find(request.records, one.name, &NamedRecord::name);
        if (auto error = make_plant(one.model.plant, record->where, plant)) return error;
    }
    return std::nullopt;
}

std::optional<Error> take_models(const std::vector<NamedModel>& models, FeedforwardRequest& request) {
    if (models.empty()) return std::nullopt;
    const IdentifiedModel& model = models.front().model;
    if (model.disturbances.empty())
        return Error{ErrorKind::not_identifiable, "record",
                     "The record does not show that the disturbance moves the measurement. Record it while the "
                     "disturbance makes a clear step."};
    if (auto error = make_plant(model.plant, "record", request.plant)) return error;
    return make_plant(model.disturbances.front().plant, "record", request.disturbance);
}

std::optional<Error> take_models(const std::vector<NamedModel>& models, InteractionRequest& request) {
    for (std::size_t i = 0; i < models.size(); ++i) {
        auto& row = request.plant[i];
        const std::string& where = request.records[i].where;
        if (auto error = make_plant(models[i].model.plant, where, row.front())) return error;
        // An input that moves nothing has no path.
        const auto& further = request.records[i].read.record.d;
        for (std::size_t j = 1; j < row.size(); ++j)
            if (const DisturbanceModel* path = further_input(models[i].model, further[j - 1].name))
                if (auto error = make_plant(path->plant, where, row[j])) return error;
    }
    return std::nullopt;
}

std::optional<Error> take_models(const std::vector<NamedModel>&, StructureRequest&) { return std::nullopt; }

}  // namespace tunewright::api
