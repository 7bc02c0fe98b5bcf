#include "api/contract/range/range_request.h"

#include <algorithm>

#include "api/contract/plant/typed.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/robust/filter_rule.h"

namespace tunewright::api {
namespace {

constexpr double kTfOverTd = 0.1;  // of a row without a Tf

const Description<RobustFilterOptions>& range_filter_contract() {
    static const auto description = [] {
        using F = RobustFilterOptions;
        Description<F> d("RangeFilter", "The measurement filter of every row; one of the two members.");
        d.field("Tf", &F::Tf, maybe(number({.exclusive_minimum = 0})), "Its time constant, fixed.", {.unit = "time"})
            .field("Tf_over_Td", &F::Tf_over_Td, maybe(number({.exclusive_minimum = 0, .maximum = 10})),
                   "Its time constant as a fraction of Td.")
            .check([](const Json&, F& filter, Reader& reader) {
                if (filter.Tf && filter.Tf_over_Td)
                    reader.fault_at("Tf_over_Td", "Tf and Tf_over_Td are both given; remove one.");
            });
        return d;
    }();
    return description;
}

void check_rows(const Json&, ScheduleWish& wish, Reader& reader) {
    if (wish.controller == ControllerKind::PI && wish.filter.Tf_over_Td) {
        const Reader::At at(reader, "filter");
        reader.fault_at("Tf_over_Td", "Tf_over_Td belongs to a PID; a PI has no Td. Give Tf, or leave the filter out.");
    }
    if (!wish.given) return;
    const Reader::At list(reader, "given");
    check_given_rows(*wish.given, reader);
}

}  // namespace

const Description<GivenRow>& given_row_contract() {
    static const auto description = [] {
        Description<GivenRow> d("GivenRow", "A row of a schedule, in the ideal form.");
        d.field("at", &GivenRow::at, number(), "Its place.", {.required = true})
            .field("Kp", &GivenRow::Kp, number({.not_zero = true}), "Gain.", {.required = true, .unit = "u/y"})
            .field("Ti", &GivenRow::Ti, number({.exclusive_minimum = 0}), "Integral time.",
                   {.required = true, .unit = "time"})
            .field("Td", &GivenRow::Td, number({.minimum = 0}), "Derivative time.", {.unit = "time"})
            .field("Tf", &GivenRow::Tf, maybe(number({.minimum = 0})),
                   "Time constant of the second-order measurement filter; 0.1 Td if not given.", {.unit = "time"})
            .field("b", &GivenRow::b, number({.minimum = 0, .maximum = 1}), "Set-point weight.");
        return d;
    }();
    return description;
}

void check_given_rows(const std::vector<GivenRow>& rows, Reader& reader) {
    for (std::size_t k = 1; k < rows.size(); ++k) {
        const Reader::At row(reader, k);
        if (!(rows[k].at > rows[k - 1].at))
            reader.fault_at("at", "at is " + shown(rows[k].at) + " after " + shown(rows[k - 1].at) +
                                      "; the rows must ascend, each place once. Sort them.");
        if (rows[k].Kp * rows[0].Kp < 0)
            reader.fault_at(
                "Kp",
                "Kp is " + shown(rows[k].Kp) + " and that of the first row " + shown(rows[0].Kp) +
                    "; all rows must have the same sign, because Kp would otherwise pass through 0 between them.");
    }
}

Codec<Interpolation> interpolation_word() {
    using enum Interpolation;
    std::vector<std::pair<std::string, Interpolation>> words;
    for (const auto interpolation : {steps, linear_in_gains, linear_in_times})
        words.emplace_back(to_string(interpolation), interpolation);
    return choice<Interpolation>(std::move(words));
}

const Description<ScheduleWish>& schedule_wish_contract() {
    static const auto description = [] {
        using W = ScheduleWish;
        const NumberRule limit{.exclusive_minimum = 1, .maximum = limits::kMaxMs};
        Description<W> d("ScheduleWish", "Limits, and the interpolation of the user's controller.");
        d.field("controller", &W::controller,
                choice<ControllerKind>({{"PID", ControllerKind::PID}, {"PI", ControllerKind::PI}}), "Its kind.")
            .field("Ms", &W::Ms, number(limit), "Limit on Ms everywhere in the range.")
            .field("Mt", &W::Mt, number(limit), "Limit on Mt everywhere in the range.")
            .field("filter", &W::filter, object(range_filter_contract()),
                   "The measurement filter; default: that of the method robust, by one rule for all rows.",
                   {.no_default = true})
            .field("aim", &W::aim, choice<range::Aim>({{"worst", range::Aim::worst}, {"mean", range::Aim::mean}}),
                   "For one setting: minimises the worst or the mean IAE relative to each point's own optimum.")
            .field("allowance", &W::allowance, number({.exclusive_minimum = 0, .maximum = 1}),
                   "Fraction by which the schedule's IAE may exceed that of each place's own optimum.")
            .field("rows", &W::rows, maybe(integer(1, range::kMaxRows)), "Number of rows; default: as few as possible.")
            .field("interpolation", &W::interpolation, interpolation_word(),
                   "Interpolation between rows: steps with hysteresis; linear in Kp, 1/Ti, Td; linear in Kp, Ti, Td.")
            .field("hysteresis", &W::hysteresis, number({.minimum = 0, .maximum = 0.2}),
                   "Hysteresis of steps, as a fraction of the range.")
            .field("between", &W::between,
                   choice<range::Between>({{"parameters", range::Between::parameters},
                                           {"frequency_response", range::Between::frequency_response}}),
                   "Interpolation of the plants between points: logarithms of the parameters, or frequency responses "
                   "for plants of different structure.")
            .field("b", &W::b, number({.minimum = 0, .maximum = 1}), "Set-point weight of every row.")
            .field("given", &W::given, maybe(list_of(object(given_row_contract()), 1, range::kMaxRows)),
                   "A schedule to evaluate: nothing is designed then.")
            .check(check_rows);
        return d;
    }();
    return description;
}

range::RangeOptions options_of(const ScheduleWish& wish) {
    range::RangeOptions options;
    options.controller = wish.controller;
    options.limits.Ms = wish.Ms;
    options.limits.Mt = wish.Mt;
    options.filter = wish.filter;
    options.aim = wish.aim;
    options.b = wish.b;
    options.allowance = wish.allowance;
    options.rows = wish.rows;
    options.interpolation = wish.interpolation;
    options.hysteresis = wish.hysteresis;
    options.between = wish.between;
    return options;
}

std::vector<ScheduleRow> rows_of(const std::vector<GivenRow>& given) {
    std::vector<ScheduleRow> rows;
    for (const GivenRow& row : given)
        rows.push_back({.at = row.at,
                        .Kp = row.Kp,
                        .Ti = row.Ti,
                        .Td = row.Td,
                        .Tf = row.Tf.value_or(kTfOverTd * row.Td),
                        .b = row.b});
    return rows;
}

std::vector<ScheduleRow> rows_of(const ScheduleWish& wish) {
    return wish.given ? rows_of(*wish.given) : std::vector<ScheduleRow>{};
}

namespace {

constexpr std::size_t kMaxPointNameLength = 100;

const Description<GivenScheduling>& scheduling_contract() {
    static const auto description = [] {
        using S = GivenScheduling;
        Description<S> d("Scheduling", "The quantity that the plant varies with: load, level, speed.");
        d.field("name", &S::name, maybe(text(kMaxPointNameLength)), "Its name.", {.no_default = true})
            .field("unit", &S::unit, maybe(text(kMaxPointNameLength)), "Label of its unit.", {.no_default = true});
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
        Description<P> d("GivenRangePoint", "The plant or the record at one place of the range.");
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
        reader.fault_at("plant", "plant and points are both given; equations need no points. Remove one of them.");
    if (!points && !plant)
        reader.fault(
            "points is missing; give two or more, such as [{\"at\": 30, \"plant\": \"4 e^(-4s)/(20s+1)\"}, "
            "{\"at\": 100, \"plant\": \"e^(-2s)/(8s+1)\"}], or equations as plant with a range.");
    if (plant && !value.contains("range"))
        reader.fault_at("range",
                        "range is missing; equations need the path through their steady states, such as "
                        "{\"along\": \"output\", \"from\": 10, \"to\": 40}.");
    if (points && value.contains("range"))
        reader.fault_at("range", "range belongs to equations; points have their own places. Remove it.");
}

/// The plant of a point as a family; empty after a fault.
std::optional<PlantFamily> family_at(const PlantModel& plant, Reader& reader) {
    const std::size_t before = reader.count();
    const auto subject = subject_of(plant, reader);
    if (!subject || !reader.clean_since(before)) return std::nullopt;
    if (subject->family() != nullptr) return *subject->family();
    if (subject->equations() != nullptr || subject->measured() != nullptr) {
        reader.fault_at("plant", subject->measured() != nullptr
                                     ? "Measured points of a frequency response cannot be a plant of a range, because "
                                       "they have no response over time. Give a model."
                                     : "Equations cannot be the plant of a point, because they apply to every place. "
                                       "Give them as the request's plant, with a range.");
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

/// The engine's checks of all points: always of their places; of their plants only if no record has to be identified.
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
                        "uncertainty is \"identified\", which needs records. For plants give the uncertainty of each, "
                        "such as {\"K\": [0.8, 1.2]}.");
}

}  // namespace

const Description<GivenWay>& way_contract() {
    static const auto description = [] {
        using enum range::Along;
        Description<GivenWay> d("RangeOfEquations", "Path of equations through their steady states.");
        d.field("along", &GivenWay::along,
                choice<range::Along>({{"output", output}, {"input", input}, {"parameter", parameter}}),
                "The quantity that moves: the output's steady value, the input's, or a parameter.")
            .field("parameter", &GivenWay::parameter, maybe(text(kMaxPointNameLength)),
                   "Along a parameter, its name: one that is a number and occurs in no other parameter's expression.")
            .field("from", &GivenWay::from, number(), "The range's lower end, absolute.", {.required = true})
            .field("to", &GivenWay::to, number(), "Its upper end, > from.", {.required = true})
            .field("hold_output", &GivenWay::hold_output, boolean(),
                   "Along a parameter, true: the input keeps the output at the operating point; false: the input is "
                   "constant.")
            .check([](const Json&, GivenWay& way, Reader& reader) {
                if (way.along == parameter && !way.parameter)
                    reader.fault_at("parameter",
                                    "parameter is missing; name the parameter of the equations that moves.");
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
                "The quantity `at`; default for equations: the quantity along which they are followed.")
            .field("points", &R::points,
                   maybe(list_of(object(range_point_contract()), range::kFewestPoints, range::kMaxPoints)),
                   "Plants or records, ascending in `at`; exactly one of points and plant.")
            .field("plant", &R::plant, maybe(plant_model_or_text()),
                   "Equations, with `range`; exactly one of points and plant.")
            .field("range", &R::way, maybe(object(way_contract())),
                   "For equations: the path through their steady states.")
            .field("identify", &R::identify, object(identify_contract()), "Identification of the records.")
            .field("uncertainty", &R::over_region, maybe(choice<bool>({{"none", false}, {"identified", true}})),
                   "identified (default for records): limits hold over each record's 95 % confidence region; none: on "
                   "the models only.")
            .field("schedule", &R::schedule, object(schedule_wish_contract()),
                   "Limits, and the interpolation of the controller.", {.no_default = true})
            .field("runs", &R::runs, boolean(), "With equations: simulate passages across the range.");
        add_terms(d);
        d.refuse("record", "A range takes a record for each point: points [{\"at\": 30, \"record\": {...}}, ...].")
            .refuse("tune", "A range is designed by its own search; give limits and kind of controller in schedule.")
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
