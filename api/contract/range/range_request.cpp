#include "api/contract/range/range_request.h"

#include <algorithm>

#include "api/contract/plant/typed.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMostNameLength = 100;

const Description<GivenScheduling>& scheduling_contract() {
    static const auto description = [] {
        using S = GivenScheduling;
        Description<S> d("Scheduling", "The quantity that the plant varies with: load, level, speed.");
        d.field("name", &S::name, maybe(text(kMostNameLength)), "Its name.", {.no_default = true})
            .field("unit", &S::unit, maybe(text(kMostNameLength)), "Label of its unit.", {.no_default = true});
        return d;
    }();
    return description;
}

void check_point_source(const Json& value, GivenRangePoint&, Reader& reader) {
    if (!value.is_object()) return;
    const bool plant = value.contains("plant"), record = value.contains("record");
    if (plant && record)
        reader.fault_at("record", "record and plant are both given; a point has one of them. Remove one.");
    if (!plant && !record)
        reader.fault(
            "The point has neither plant nor record; give one, such as "
            "{\"at\": 30, \"plant\": {\"type\": \"fopdt\", \"K\": 2, \"T\": 10, \"L\": 3}}.");
}

const Description<GivenRangePoint>& range_point_contract() {
    static const auto description = [] {
        using P = GivenRangePoint;
        Description<P> d("GivenRangePoint", "What is known at one place of the range.");
        d.field("at", &P::at, number(), "The place: the scheduling variable's value there.", {.required = true})
            .field("plant", &P::plant, maybe(plant_model_or_text()),
                   "A linear plant, perhaps uncertain, or several of them.")
            .field("record", &P::record, maybe(object(record_contract())), "A test that was recorded there.")
            .check_presence(check_point_source);
        return d;
    }();
    return description;
}

void check_range_source(const Json& value, RangeRequest&, Reader& reader) {
    const bool points = value.contains("points"), plant = value.contains("plant");
    if (points && plant)
        reader.fault_at("plant",
                        "plant and points are both given: equations know every place by themselves. Remove "
                        "one of them.");
    if (!points && !plant)
        reader.fault(
            "points is missing; give two or more, such as [{\"at\": 30, \"plant\": \"4 e^(-4s)/(20s+1)\"}, "
            "{\"at\": 100, \"plant\": \"e^(-2s)/(8s+1)\"}], or equations as plant with a range.");
    if (plant && !value.contains("range"))
        reader.fault_at("range",
                        "range is missing; equations need the way through their steady states, such as "
                        "{\"along\": \"output\", \"from\": 10, \"to\": 40}.");
    if (points && value.contains("range"))
        reader.fault_at("range", "range belongs to equations; points say themselves where they lie. Remove it.");
}

/// The plant of a point as a family; nothing after a fault.
std::optional<PlantFamily> family_at(const PlantModel& plant, Reader& reader) {
    const std::size_t before = reader.count();
    const auto subject = subject_of(plant, reader);
    if (!subject || !reader.clean_since(before)) return std::nullopt;
    if (subject->family() != nullptr) return *subject->family();
    if (subject->equations() != nullptr || subject->measured() != nullptr) {
        reader.fault_at("plant", subject->measured() != nullptr
                                     ? "Measured points of a frequency response are no plant of a range: nothing is "
                                       "known over time. Give a model."
                                     : "Equations are no plant of a point: they know every place. Give them as the "
                                       "request's plant, with a range.");
        return std::nullopt;
    }
    return family_of(*subject->nominal());
}

void take_points(RangeRequest& request, Reader& reader) {
    const Reader::At list(reader, "points");
    for (std::size_t k = 0; k < request.points->size(); ++k) {
        GivenRangePoint& point = (*request.points)[k];
        const Reader::At at(reader, k);
        ReadRecord read;
        if (point.record) {
            const Reader::At record(reader, "record");
            read = resolve(std::move(*point.record), request.units.value_or(Units{}), reader);
            request.question.points.push_back({point.at, std::move(read.record)});
        } else if (auto family = family_at(*point.plant, reader)) {
            request.question.points.push_back({point.at, std::move(*family)});
        }
        request.reads.push_back(std::move(read));
    }
}

/// What the engine says of the points together: of places always, of plants where no record has to be identified.
void check_points_together(RangeRequest& request, bool plants_are_clean, Reader& reader) {
    std::vector<double> places;
    for (const GivenRangePoint& point : *request.points) places.push_back(point.at);
    const std::size_t before = reader.count();
    for (const Error& fault : range::place_faults(places)) reader.fault_below(fault.where, 0, fault.message);
    if (!plants_are_clean || !reader.clean_since(before)) return;
    std::vector<range::RangePoint> points;
    for (const auto& point : request.question.points)
        if (const auto* family = std::get_if<PlantFamily>(&point.content)) points.push_back({point.at, *family});
    if (points.size() < places.size()) return;
    const auto model = model_of_points(points, request.schedule.between);
    if (!model) reader.fault_below(model.error().where, 0, model.error().message);
}

void check_range(const Json&, RangeRequest& request, Reader& reader) {
    const std::size_t before = reader.count();
    RangeQuestion& question = request.question;
    question.identify = request.identify;
    question.over_region = request.over_region.value_or(request.schedule.between == range::Between::parameters);
    question.options = options_of(request.schedule);
    question.given = rows_of(request.schedule);
    question.runs = request.runs;
    if (request.points) {
        take_points(request, reader);
        check_points_together(request, reader.clean_since(before), reader);
    } else {
        follow_way(request, reader);
        question.branch = request.branch;
    }
    const Units units = request.units.value_or(Units{});
    const GivenScheduling scheduling = request.scheduling.value_or(GivenScheduling{});
    if (question.branch) {
        question.scheduling.name = question.branch->scheduling_name();
        if (request.way->along != range::Along::parameter)
            question.scheduling.unit = (request.way->along == range::Along::input ? units.u : units.y).value_or("");
    }
    question.scheduling.name = scheduling.name.value_or(question.scheduling.name);
    question.scheduling.unit = scheduling.unit.value_or(question.scheduling.unit);
    const bool records = request.points && std::ranges::any_of(*request.points, [](const GivenRangePoint& point) {
                             return point.record.has_value();
                         });
    if (request.over_region.value_or(false) && !records)
        reader.fault_at("uncertainty",
                        "uncertainty is \"identified\", which needs records. For plants give each its own "
                        "uncertainty, such as {\"K\": [0.8, 1.2]}.");
}

}  // namespace

const Description<GivenWay>& way_contract() {
    static const auto description = [] {
        using enum range::Along;
        Description<GivenWay> d("RangeOfEquations", "The way of equations through their steady states.");
        d.field("along", &GivenWay::along,
                choice<range::Along>({{"output", output}, {"input", input}, {"parameter", parameter}}),
                "What is moved: the output's steady value, the input's, or a parameter.")
            .field("parameter", &GivenWay::parameter, maybe(text(kMostNameLength)),
                   "Its name, along a parameter: one that is a number and in no other parameter's expression.")
            .field("from", &GivenWay::from, number(), "The range's lower end, absolute.", {.required = true})
            .field("to", &GivenWay::to, number(), "Its upper end, > from.", {.required = true})
            .field("hold_output", &GivenWay::hold_output, boolean(),
                   "Along a parameter: the input keeps the output at the operating point; false: the input stays.")
            .check([](const Json&, GivenWay& way, Reader& reader) {
                if (way.along == parameter && !way.parameter)
                    reader.fault_at("parameter", "parameter is missing; along a parameter of the equations name it.");
                if (way.along != parameter && way.parameter)
                    reader.fault_at("parameter",
                                    "parameter belongs to along \"parameter\"; remove it, or choose that.");
                if (!(way.from < way.to))
                    reader.fault_at("to",
                                    "to is " + shown(way.to) + " and from " + shown(way.from) + "; to must be > from.");
            });
        return d;
    }();
    return description;
}

void follow_way(RangeSubject& subject, Reader& reader) {
    const auto* equations = std::get_if<NonlinearPlant>(&*subject.plant);
    if (equations == nullptr)
        return reader.fault_at("plant",
                               "A range along steady states needs equations, a plant of type nonlinear. For "
                               "linear plants give points.");
    const GivenWay& way = *subject.way;
    auto branch = range::SteadyBranch::follow({.plant = *equations,
                                               .along = way.along,
                                               .parameter = way.parameter.value_or(""),
                                               .from = way.from,
                                               .to = way.to,
                                               .hold_output = way.hold_output});
    if (!branch) return reader.fault_below(branch.error().where, 0, branch.error().message);
    subject.branch = std::make_shared<const range::SteadyBranch>(std::move(*branch));
    const auto model = model_of_branch(subject.branch);
    if (!model) reader.fault_below(model.error().where, 0, model.error().message);
}

const Description<RangeRequest>& range_request_contract() {
    static const auto description = [] {
        using R = RangeRequest;
        Description<R> d("RangeRequest",
                         "A loop over its whole operating range: points with plants or records, or equations, to one "
                         "robust setting and a schedule.");
        add_labels(d);
        d.field("scheduling", &R::scheduling, maybe(object(scheduling_contract())),
                "What `at` is; of equations what they are followed along, if not given.")
            .field("points", &R::points,
                   maybe(list_of(object(range_point_contract()), range::kFewestPoints, range::kMostPoints)),
                   "Plants or records, ascending in `at`; exactly one of points and plant.")
            .field("plant", &R::plant, maybe(plant_model_or_text()),
                   "Equations, with `range`; exactly one of points and plant.")
            .field("range", &R::way, maybe(object(way_contract())),
                   "Of equations: the way through their steady states.")
            .field("identify", &R::identify, object(identify_contract()), "How records become models.")
            .field(
                "uncertainty", &R::over_region, maybe(choice<bool>({{"none", false}, {"identified", true}})),
                "identified: limits hold over each record's 95 % confidence region, as they do for records where it is "
                "not given; none: on the models alone.")
            .field("schedule", &R::schedule, object(schedule_wish_contract()),
                   "Limits, and how the controller moves between its rows.", {.no_default = true})
            .field("runs", &R::runs, boolean(), "With equations: simulate passages across the range.");
        add_terms(d);
        d.refuse("record", "A range takes a record for each point: points [{\"at\": 30, \"record\": {...}}, ...].")
            .refuse("tune", "A range is designed by its own search; limits and kind of controller stand in schedule.")
            .check_presence(check_range_source)
            .check(check_range)
            .example({{"scheduling", {{"name", "load"}, {"unit", "%"}}},
                      {"points", Json::array({Json{{"at", 30}, {"plant", "4 e^(-4s)/(20s+1)"}},
                                              Json{{"at", 60}, {"plant", "2 e^(-3s)/(12s+1)"}},
                                              Json{{"at", 100}, {"plant", "e^(-2s)/(8s+1)"}}})},
                      {"schedule", {{"interpolation", "linear_in_gains"}}}});
        return d;
    }();
    return description;
}

bool is_range_request(const Json& request) {
    return request.is_object() && (request.contains("points") || request.contains("range") ||
                                   request.contains("scheduling") || request.contains("schedule"));
}

}  // namespace tunewright::api
