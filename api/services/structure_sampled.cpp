#include "api/services/structure_sampled.h"

#include <algorithm>
#include <utility>

#include "api/code/structure_program.h"
#include "api/describe/suggest.h"

namespace tunewright::api {
namespace {

using structure::SampledScene;

/// A problem of the program, at the member of `sampled` that it is about; at `sampled` if it is about none.
Problem below_sampled(Problem problem) {
    for (auto& error : problem.errors) {
        std::string name = error.pointer.substr(error.pointer.rfind('/') + 1);
        if (name == "Lf") name = "sample_time";  // a dead time of too many calls
        if (error.pointer.starts_with("/outer/u_m")) name.replace(0, 1, "r2");
        error.pointer = sampled_wish_contract().has(name) ? "/sampled/" + name : "/sampled";
    }
    return problem;
}

std::optional<Problem> unknown_step(const SampledWish& wish, const SampledScene& scene) {
    std::vector<std::string> known;
    for (const structure::SampledStep& step : scene.steps) known.push_back(step.name);
    Reader reader;
    const Reader::At sampled(reader, "sampled"), steps(reader, "steps");
    for (const auto& [name, size] : wish.steps)
        if (std::ranges::find(known, name) == known.end())
            reader.fault_at(name, name + " is no input here; the inputs are " + listed(known, "and") + ".");
    return reader.problem();
}

AskedCode asked_of(const StructureRequest& request) {
    AskedCode asked;
    asked.question = *request.sampled;
    if (!request.devices.empty() && !asked.question.sample_time && request.devices.front().sampled())
        asked.question.sample_time = request.devices.front().Ts;
    return asked;
}

}  // namespace

Expected<SampledPlants> sampled_plants(const CascadeRequest& request, const CascadeAnswer&) {
    auto scene = structure::cascade_scene(request.plants());
    if (!scene) return scene.error();
    return SampledPlants{std::move(*scene), {"y1", "y2"}};
}

Expected<SampledPlants> sampled_plants(const LevelRequest& request, const LevelAnswer&) {
    SampledPlants out{
        structure::level_scene(request.problem.area, request.problem.flow.value_or(structure::FlowLoop{})), {"level"}};
    // The step of the inflow, whose size is the largest unless another is given.
    structure::SampledStep& inflow = out.scene.steps.front();
    inflow.name = "inflow";
    for (auto& [input, size] : inflow.loads) size *= request.problem.step;
    return out;
}

Expected<SampledPlants> sampled_plants(const FeedforwardRequest& request, const FeedforwardAnswer&) {
    return SampledPlants{structure::feedforward_scene(*request.plant, *request.disturbance), {"y"}};
}

Expected<SampledPlants> sampled_plants(const InteractionRequest& request, const InteractionAnswer& answer) {
    SampledPlants out{
        structure::interaction_scene(structure::paired(request.plant, answer.gains.pairings[answer.chosen].input_of)),
        {}};
    for (std::size_t i = 0; i < request.plant.size(); ++i) out.names.push_back("y_" + std::to_string(i + 1));
    return out;
}

Expected<SampledPlants> sampled_plants(const PredictorRequest& request, const PredictorAnswer&) {
    return SampledPlants{structure::loop_scene(*request.plant), {"y"}};
}

std::variant<SampledView, Problem> run_program(const StructureRequest& request, const Json& answer,
                                               Expected<SampledPlants> plants, const RunControl& control) {
    if (!plants) return to_problem(plants.error());
    if (auto problem = unknown_step(*request.sampled, plants->scene)) return *std::move(problem);
    auto made = structure_program(answer, Json(), asked_of(request));
    if (auto* problem = std::get_if<Problem>(&made)) return below_sampled(std::move(*problem));
    const auto& [program, sample_time] = std::get<StructureProgram>(made);
    SampledView out{
        .sample_time = sample_time.seconds, .answer = {}, .names = std::move(plants->names), .points = request.points};
    for (const code::Declaration& output : code::of_role(program, code::VariableRole::output))
        out.names.push_back(output.name);
    auto run = structure::run_sampled(program, plants->scene, request.sampled->steps, control);
    if (!run)
        return run.error().kind == ErrorKind::cancelled ? to_problem(run.error())
                                                        : below_sampled(to_problem(run.error()));
    out.answer = std::move(*run);
    return out;
}

}  // namespace tunewright::api
