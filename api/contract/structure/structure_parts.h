// Parts that the requests and answers of the calls for cascade, level, feedforward, interaction and predictor share.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/contract/device/code_question.h"
#include "api/contract/device/device.h"
#include "api/contract/request.h"
#include "api/contract/result/identified_model.h"
#include "engine/structure/conclusions.h"
#include "engine/structure/drawing/drawing.h"
#include "engine/structure/loop_design.h"
#include "engine/structure/program/sampled_structure.h"
#include "engine/structure/step_figures.h"

namespace tunewright::api {

/// A record in place of plants; `where`: its place in the request.
struct NamedRecord {
    std::string name, where;
    ReadRecord read;
};

/// The model of a record.
struct NamedModel {
    std::string name;
    IdentifiedModel model;
};

/// The members of every request about a structure, which may also be a job.
struct StructureRequest : JobTerms {
    std::optional<std::string> name;
    std::optional<Units> units;
    int points = 200;  ///< of each series of the drawing; 0: none
    std::vector<GivenDevice> implement;
    std::vector<device::DeviceModel> devices;  ///< of `implement`: one for each controller, or one for all

    std::optional<SampledWish> sampled;
    std::vector<NamedRecord> records;  ///< a model of each takes the place of plants

    std::string time_unit() const { return units.value_or(Units{}).time_or_default(); }
};

/// A controller of an answer as it is typed into the user's product.
struct StructureTyping {
    std::string loop;
    OrReason<device::Fitted> fitted;
};

/// The program of the controllers on the plants, call by call.
struct SampledView {
    double sample_time = 0;
    structure::SampledAnswer answer;
    std::vector<std::string> names;  ///< of the measurements, then of the program's outputs
    int points = 0;                  ///< of each series, at most
};

/// The members of every answer.
struct StructureAnswer {
    std::optional<Units> units;
    std::string request_hash;        ///< "" for a call
    bool partial = false;            ///< stopped: the best so far
    std::vector<NamedModel> models;  ///< of the records
    std::optional<SampledView> sampled;
    structure::StructureDrawing drawing;
    std::vector<StructureTyping> settings;
    structure::Conclusions verdict;
};

/// {"code", "figures"}.
const Description<structure::Conclusion>& conclusion_contract();
const Description<StructureTyping>& structure_typing_contract();
const Description<NamedModel>& named_model_contract();

const Description<SampledView>& sampled_view_contract();

/// Reads a record that stands for plants, at the reader's place, into the request. With `further`: it must have so many
/// further measured inputs, d, and `needs` says what they are.
void take_record(StructureRequest& request, std::string name, std::string where, GivenRecord given, std::size_t further,
                 const char* needs, Reader& reader);

void write_responses(const structure::StructureDrawing& drawing, Writer& out);
Json responses_schema(SchemaBook& book);
void write_curves(const structure::StructureDrawing& drawing, Writer& out);
Json curves_schema(SchemaBook& book);

/// Devices from `implement`; faults are at `implement`.
void resolve_devices(StructureRequest& request, Reader& reader);
/// Reports at `implement` a list with neither one entry nor one for each of so many controllers.
void check_device_count(const StructureRequest& request, std::size_t controllers, Reader& reader);

/// The member `structure`, which tells a job's request and its result apart from others.
template <class T>
void add_structure_name(Description<T>& d, const char* structure) {
    d.field(
        "structure",
        [structure](const Json& value, T&, Reader& reader) {
            if (value != structure)
                reader.fault("structure is " + shown(value) + "; here it must be " + structure + ".");
        },
        [structure](const T&, Writer& out) { out.text(structure); },
        [structure](SchemaBook&) {
            return Json{{"const", structure}};
        },
        "The structure.");
}

Codec<std::optional<Units>> units_with_level();  ///< in which y may be called level
Codec<StructureRequest> drawing_wish();          ///< {"points": 200}
Codec<StructureRequest> devices_wish();          ///< a device, or one for each controller

/// The members of every request. `controllers`: how many there are; nothing: the structure's own check counts devices.
template <class Request>
void add_structure_members(Description<Request>& d, const char* structure, std::optional<std::size_t> controllers) {
    add_structure_name(d, structure);
    d.field("name", &Request::name, maybe(text(kMaxNameLength)), "A label, such as the loop's tag.")
        .field("units", &Request::units, units_with_level(), "Labels of the units, echoed; level is y.");
    d.field(
         "evaluate", [wish = drawing_wish()](const Json& v, Request& r, Reader& reader) { wish.read(v, r, reader); },
         {}, drawing_wish().schema, "points of each series of the drawing, default 200; 0: none.")
        .field(
            "implement",
            [wish = devices_wish()](const Json& v, Request& r, Reader& reader) { wish.read(v, r, reader); }, {},
            devices_wish().schema,
            "The user's controller as for one loop; or a list, one for each controller in the order of the answer.")
        .field("sampled", &Request::sampled, maybe(object(sampled_wish_contract())),
               "Also run the program of the controllers call by call, with its limits and anti-windup. Signals are "
               "deviations from the operating point, limits are not.")
        .check([structure, controllers](const Json&, Request& r, Reader& reader) {
            resolve_devices(r, reader);
            if (controllers) check_device_count(r, *controllers, reader);
            const Reader::At at(reader, "sampled");
            if (r.sampled) refuse_others(*r.sampled, structure, reader);
        });
    add_terms(d);
}

/// The members of every answer that follow its own.
template <class Answered>
void add_answer_members(Description<Answered>& d) {
    using A = StructureAnswer;
    d.field("partial", &A::partial, unless<bool>(boolean(), [](bool partial) { return !partial; }),
            "true: the search was stopped; this is the best so far.")
        .field("verdict", &A::verdict, list_of(answer(conclusion_contract())), "Conclusions.")
        .field("identified", &A::models,
               unless<std::vector<NamedModel>>(list_of(answer(named_model_contract())),
                                               [](const auto& all) { return all.empty(); }),
               "The models of the records.")
        .field("sampled", &A::sampled, maybe(answer(sampled_view_contract())),
               "With sampled: the same loops with the controllers' program.")
        .field("settings", &A::settings,
               unless<std::vector<StructureTyping>>(list_of(answer(structure_typing_contract())),
                                                    [](const auto& all) { return all.empty(); }),
               "With implement: what is typed into the user's controller.")
        .field(
            "responses", {}, [](const Answered& a, Writer& out) { write_responses(a.drawing, out); }, responses_schema,
            "Series over time; the steps have the size 1, or the largest step of a level.")
        .field(
            "sensitivities", {}, [](const Answered& a, Writer& out) { write_curves(a.drawing, out); }, curves_schema,
            "|S| over frequency, of the loop broken at one place, and mu; with its limit, if it has one.")
        .field(
            "version", {}, [](const Answered&, Writer& out) { out.text(TUNEWRIGHT_VERSION); }, words().schema,
            "Version of the service.")
        .field("units", &A::units, only_answered(maybe(object(units_contract()))), "As in the request.")
        .field("request_hash", &A::request_hash,
               unless<std::string>(words(), [](const std::string& hash) { return hash.empty(); }),
               "Of a job: SHA-256 of the request in its canonical form.");
}

/// One linear plant, as its object or a text, ready for computing. Uncertainty is refused.
Codec<std::optional<LinearPlant>> linear_plant();

/// A controller in any linear form, as its ideal form.
Codec<std::optional<IdealPid>> linear_controller();

/// For answers only: in the ideal form.
Codec<IdealPid> ideal_controller();

/// {"method": "robust", "controller": "PI", "Ms": 1.4, "Mt": 1.4}.
const Description<structure::LoopDesign>& loop_design_contract();

/// Figures of y after a unit step.
struct StepView {
    Figure IAE, IE, peak, TV;

    StepView() = default;
    /// `why` not empty: none is known, for this reason.
    StepView(const Figure& IAE, const Figure& IE, double peak, double TV, const std::string& why);
};
const Description<StepView>& step_view_contract();

/// The value, or `why` if that is not empty.
Figure known_unless(const Figure& value, const std::string& why);

/// A figure that is computed from a part of an answer.
template <class Part>
Codec<Part> computed_figure(Callable<Figure(const Part&)> value) {
    Codec<Part> codec;
    codec.write = [value](const Part& part, Writer& out) { figure().write(value(part), out); };
    codec.schema = figure().schema;
    codec.undefined = [value](const Part& part) { return !value(part); };
    codec.why = [value](const Part& part) { return value(part).why; };
    return codec;
}

/// A number that is infinite for the reason `why`, or for the description's.
Codec<double> finite_figure(std::string why);
/// A peak over frequency, 0 where the loop is not stable.
Codec<double> peak_figure();

/// An object of figures, with the reasons of those that are not known, and its schema.
void write_figures(Writer& out, const std::vector<std::pair<std::string, Figure>>& figures);
Json figures_schema(std::initializer_list<const char*> names);

}  // namespace tunewright::api
