#include "api/contract/structure/interaction_call.h"

#include <algorithm>
#include <cmath>

namespace tunewright::api {
namespace {

constexpr std::size_t kMinLoops = 2, kMaxLoops = 3;
constexpr const char* kUnstableLoops = "The loops are not stable together.";

bool is_no_path(const Json& value) { return value.is_null() || value == 0 || value == "0"; }

void read_matrix(const Json& value, structure::PlantMatrix& target, Reader& reader) {
    if (!value.is_array() || value.size() < kMinLoops || value.size() > kMaxLoops)
        return reader.fault(
            "plant must be two or three rows, one for each output, such as [[\"2 e^(-s)/(8s+1)\", 0], [\"1/(5s+1)\", "
            "\"3 e^(-2s)/(9s+1)\"]].");
    const auto plant = linear_plant();
    for (std::size_t i = 0; i < value.size(); ++i) {
        const Reader::At row(reader, i);
        target.emplace_back(value.size());
        if (!value[i].is_array() || value[i].size() != value.size()) {
            reader.fault("This row must have " + std::to_string(value.size()) +
                         " plants, one for each input; write 0 for a path that is not there.");
            continue;
        }
        for (std::size_t j = 0; j < value.size(); ++j) {
            const Reader::At cell(reader, j);
            if (!is_no_path(value[i][j])) plant.read(value[i][j], target[i][j], reader);
        }
    }
}

Json matrix_schema(SchemaBook& book) {
    Json cell = linear_plant().schema(book);
    cell["oneOf"].push_back({{"type", "null"}});
    cell["oneOf"].push_back({{"const", 0}});
    const Json row{{"type", "array"}, {"items", cell}, {"minItems", kMinLoops}, {"maxItems", kMaxLoops}};
    return {{"type", "array"}, {"items", row}, {"minItems", kMinLoops}, {"maxItems", kMaxLoops}};
}

Codec<InteractionControllers> controllers_codec(bool may_design) {
    const auto each = list_of(linear_controller(), kMinLoops, kMaxLoops);
    const auto kind = choice<ControllerKind>({{"PI", ControllerKind::PI}, {"PID", ControllerKind::PID}});
    Codec<InteractionControllers> codec;
    codec.read = [=](const Json& value, InteractionControllers& target, Reader& reader) {
        if (may_design && value.is_string())
            kind.read(value, target.kind, reader);
        else
            each.read(value, target.given, reader);
    };
    codec.schema = [=](SchemaBook& book) {
        if (!may_design) return each.schema(book);
        return Json{{"oneOf", Json::array({kind.schema(book), each.schema(book)})}};
    };
    codec.skip = [](const InteractionControllers&) { return true; };
    return codec;
}

Codec<std::vector<int>> pairing_codec() {
    auto codec = list_of(integer(1, int(kMaxLoops)), kMinLoops, kMaxLoops);
    return codec;
}

const auto& mu_limit_contract() {
    using L = decltype(InteractionRequest::limit);
    static const auto description = [] {
        Description<L> d("InteractionLimit", "The limit of the design.");
        d.field("mu", &L::mu, number({.exclusive_minimum = 1, .maximum = limits::kMaxMs}),
                "On the structured peak of the sensitivity.");
        return d;
    }();
    return description;
}

const auto& output_weights_contract() {
    using W = decltype(InteractionRequest::weights);
    static const auto description = [] {
        Description<W> d("InteractionWeights", "Weights of the IAE.");
        d.field("y", &W::y,
                unless<std::vector<double>>(numbers(kMinLoops, kMaxLoops, {.exclusive_minimum = 0}),
                                            [](const auto& list) { return list.empty(); }),
                "Of each output, such as 1 over its range; default: 1 each.");
        return d;
    }();
    return description;
}

void check_sources(InteractionRequest& request, Reader& reader) {
    if (request.plant.empty() == !request.given_records)
        return reader.fault_at("plant",
                               "Give either plant, a matrix such as [[\"2 e^(-s)/(8s+1)\", 0], [\"1/(5s+1)\", "
                               "\"3 e^(-2s)/(9s+1)\"]], or records, one of each output.");
    if (!request.given_records) return;
    const std::size_t n = request.given_records->size();
    request.plant.assign(n, std::vector<std::optional<LinearPlant>>(n));
    const Reader::At records(reader, "records");
    for (std::size_t i = 0; i < n; ++i) {
        const Reader::At at(reader, i);
        take_record(request, "output " + std::to_string(i + 1), "records/" + std::to_string(i),
                    std::move((*request.given_records)[i]), n - 1,
                    "Each record needs all inputs: u the first of them, and the others as d, such as columns {\"u\": "
                    "\"FIC1.OP\", \"d\": [\"FIC2.OP\"], \"y\": \"TIC1.PV\"}.",
                    reader);
    }
}

void check_interaction(const Json&, InteractionRequest& request, Reader& reader) {
    check_sources(request, reader);
    const std::size_t n = request.plant.size();
    const auto count = [&](const char* name, std::size_t given) {
        if (given != 0 && given != n)
            reader.fault_at(name, std::string(name) + " has " + std::to_string(given) + " entries; give " +
                                      std::to_string(n) + ", one for each output.");
    };
    if (request.compare.size() == 2 && request.compare[0] == request.compare[1])
        reader.fault_at("compare", "compare names " + request.compare[0] + " twice. Remove one of them.");
    check_device_count(request, n, reader);
    count("controllers", request.controllers.given.size());
    if (request.baseline) count("baseline", request.baseline->given.size());
    {
        const Reader::At weights(reader, "weights");
        count("y", request.weights.y.size());
    }
    if (!request.pairing) return;
    count("pairing", request.pairing->size());
    std::vector<int> sorted = *request.pairing;
    std::ranges::sort(sorted);
    for (std::size_t i = 0; i < sorted.size(); ++i)
        if (sorted.size() == n && sorted[i] != int(i) + 1)
            return reader.fault_at("pairing", "pairing must name each input once, from 1 to " + std::to_string(n) +
                                                  ", such as " + (n == 2 ? "[2, 1]." : "[2, 1, 3]."));
}

Json table_schema(SchemaBook&) {
    return {{"type", "array"}, {"items", {{"type", "array"}, {"items", {{"type", {"number", "null"}}}}}}};
}

void write_table(const structure::Table& table, Writer& out) {
    out.begin_array();
    for (const auto& row : table) {
        out.begin_array();
        for (const double value : row) std::isfinite(value) ? out.number(value) : out.null();
        out.end_array();
    }
    out.end_array();
}

Json row_schema(SchemaBook&) { return {{"type", "array"}, {"items", {{"type", {"number", "null"}}}}}; }

void write_row(const std::vector<double>& row, Writer& out) {
    out.begin_array();
    for (const double value : row) std::isfinite(value) ? out.number(value) : out.null();
    out.end_array();
}

void write_inputs(const std::vector<int>& input_of, Writer& out) {
    out.begin_array();
    for (const int input : input_of) out.integer(input + 1);
    out.end_array();
}

Json whole_numbers_schema(SchemaBook&) { return {{"type", "array"}, {"items", {{"type", "integer"}}}}; }

const Description<structure::Pairing>& pairing_contract() {
    static const auto description = [] {
        using P = structure::Pairing;
        Description<P> d("Pairing", "One way to pair outputs with inputs.");
        d.field(
             "inputs", {}, [](const P& p, Writer& out) { write_inputs(p.input_of, out); }, whole_numbers_schema,
             "The input of each output, from 1.")
            .field("niederlinski", &P::niederlinski, figure(), "Niederlinski index.")
            .field(
                "relative_gains", {}, [](const P& p, Writer& out) { write_row(p.relative, out); }, row_schema,
                "Of each pair at steady state.")
            .field(
                "relative_gains_at_crossover", {}, [](const P& p, Writer& out) { write_row(p.at_crossover, out); },
                row_schema, "Their magnitudes near the crossovers.")
            .field("possible", &P::possible, only_answered(boolean()),
                   "Integral action in all loops, and in those that are left when one is opened, can be stable.")
            .why_null("A pair has no gain at steady state.");
        return d;
    }();
    return description;
}

bool all_finite(const std::vector<double>& row) {
    return std::ranges::all_of(row, [](double value) { return std::isfinite(value); });
}

/// The members that figures of any controllers have.
template <class T>
void add_figures(Description<T>& d) {
    using F = structure::InteractionFigures;
    const auto row = [&](const char* name, std::vector<double> F::*member, const char* sentence) {
        Codec<F> codec;
        codec.write = [member](const F& f, Writer& out) { write_row(f.*member, out); };
        codec.schema = row_schema;
        codec.undefined = [member](const F& f) { return !all_finite(f.*member); };
        codec.why = [](const F&) { return "With the others in manual the loop is not stable."; };
        d.field(name, &T::figures, codec, sentence);
    };
    const auto table = [&](const char* name, structure::Table F::*member, const char* sentence) {
        Codec<F> codec;
        codec.write = [member](const F& f, Writer& out) { write_table(f.*member, out); };
        codec.schema = table_schema;
        codec.undefined = [member](const F& f) { return !std::ranges::all_of(f.*member, all_finite); };
        codec.why = [](const F&) { return structure::kRestsElsewhere; };
        d.field(name, &T::figures, codec, sentence);
    };
    const auto value = [&](const char* name, double F::*member, const char* sentence, const FieldOptions& options) {
        d.field(name, &T::figures, computed_figure<F>([member](const F& f) {
                    return known_unless(f.*member, f.stable ? "" : kUnstableLoops);
                }),
                sentence, options);
    };
    d.field(
        "stable", {}, [](const T& t, Writer& out) { out.boolean(t.figures.stable); }, boolean().schema,
        "All loops together are stable; else the figures are null or empty.");
    row("Ms_alone", &F::Ms_alone, "max |S| of each loop with the others in manual; null: not stable then.");
    row("Ms_others_closed", &F::Ms_others_closed, "max |S| of each loop with the others in automatic.");
    value("mu", &F::mu, "Peak of the structured singular value of the sensitivity.", {});
    value("omega_mu", &F::omega_mu, "Its frequency.", {.unit = "1/time"});
    value("Lcm_dB", &F::log_modulus, "Largest log modulus of Luyben.", {.unit = "dB"});
    table("IAE_load", &F::IAE_load, "Row: the input of a loop at which a unit load acts; column: the output.");
    table("IAE_setpoint", &F::IAE_setpoint, "Row: the set point that makes a unit step; column: the output.");
}

const Description<ComparedControllers>& compared_contract() {
    static const auto description = [] {
        using C = ComparedControllers;
        Description<C> d("ComparedControllers", "Controllers for comparison.");
        d.field("name", &C::name, words(),
                "blt, detuned, no_decoupler, static_decoupler, simplified_decoupler or baseline.")
            .field("controllers", &C::controllers, only_answered(list_of(ideal_controller())),
                   "In the order of the outputs.");
        add_figures(d);
        d.field("cost", &C::cost, figure(), "Weighted sum of IAE_load.")
            .field("decoupling", &C::decoupling, maybe(answer(decoupling_contract())), "The decoupler, with one.")
            .field("why_not", &C::why, unless<std::string>(words(), [](const auto& text) { return text.empty(); }),
                   "Why there are none.")
            .why_null(kUnstableLoops);
        return d;
    }();
    return description;
}

void write_subsets(const std::vector<std::vector<int>>& subsets, Writer& out) {
    out.begin_array();
    for (const auto& loops : subsets) write_inputs(loops, out);
    out.end_array();
}

void write_manual(const InteractionAnswer& a, Writer& out) {
    out.begin_object();
    out.key("may_open").begin_array();
    for (const bool may : a.figures.may_open) out.boolean(may);
    out.end_array();
    out.key("unstable_in_automatic");
    write_subsets(a.figures.unstable_subsets, out);
    out.end_object();
}

Json manual_schema(SchemaBook& book) {
    return {{"type", "object"},
            {"properties",
             {{"may_open", {{"type", "array"}, {"items", {{"type", "boolean"}}}}},
              {"unstable_in_automatic", {{"type", "array"}, {"items", whole_numbers_schema(book)}}}}},
            {"required", {"may_open", "unstable_in_automatic"}}};
}

}  // namespace

const Description<InteractionRequest>& interaction_request_contract() {
    static const auto description = [] {
        using R = InteractionRequest;
        Codec<structure::PlantMatrix> matrix;
        matrix.read = read_matrix;
        matrix.schema = matrix_schema;
        matrix.skip = [](const structure::PlantMatrix& plant) { return plant.empty(); };
        Description<R> d("InteractionRequest", "Two or three loops whose outputs depend on each other's inputs.");
        add_structure_members(d, "interaction", std::nullopt);
        d.field("plant", &R::plant, matrix,
                "A row for each output, a column for each input; 0 or null: a path that is not there.")
            .field("records", &R::given_records, maybe(list_of(object(record_contract()), kMinLoops, kMaxLoops)),
                   "In place of the plant: for each output a record in which all inputs move, u the first of them, d "
                   "the others in their order, and y the output.")
            .field(
                "pairing",
                [codec = maybe(pairing_codec())](const Json& value, R& request, Reader& reader) {
                    if (!value.is_null()) codec.read(value, request.pairing, reader);
                },
                {}, or_null(pairing_codec().schema),
                "The input of each output, from 1, such as [2, 1]; null: the best pairing.")
            .field("controllers", &R::controllers, controllers_codec(true),
                   "PI (default) or PID: what is designed; or controllers to judge, in the order of the outputs.",
                   {.no_default = true})
            .field("limit", &R::limit, object(mu_limit_contract()), "The limit of the design.")
            .field("weights", &R::weights, object(output_weights_contract()), "Weights of the IAE.")
            .field("baseline", &R::baseline, maybe(controllers_codec(false)),
                   "The controllers in use, in the order of the outputs.")
            .field("decoupler", &R::decoupler, decoupler_kind(),
                   "A decoupler in front of the plant; with it the loops without one are designed too and compared.")
            .field("compare", &R::compare,
                   list_of(choice<std::string>({{"blt", "blt"},
                                                {"detuned", "detuned"},
                                                {"static_decoupler", "static_decoupler"},
                                                {"simplified_decoupler", "simplified_decoupler"}}),
                           0, 4),
                   "blt: Luyben's biggest log modulus tuning; detuned: the same, weakened until the limit holds; "
                   "static_decoupler and simplified_decoupler: controllers that are designed with it.")
            .check(check_interaction)
            .example({{"plant", Json::array({Json::array({"12.8 e^(-s)/(16.7s+1)", "-18.9 e^(-3s)/(21s+1)"}),
                                             Json::array({"6.6 e^(-7s)/(10.9s+1)", "-19.4 e^(-3s)/(14.4s+1)"})})},
                      {"limit", {{"mu", 1.8}}}});
        return d;
    }();
    return description;
}

const Description<InteractionAnswer>& interaction_answer_contract() {
    static const auto description = [] {
        using A = InteractionAnswer;
        Description<A> d("InteractionAnswer", "Interaction, pairings, and controllers with their figures.");
        add_structure_name(d, "interaction");
        d.field(
             "rga", {}, [](const A& a, Writer& out) { write_table(a.gains.relative, out); }, table_schema,
             "Relative gains at steady state: a row for each output, a column for each input.")
            .field(
                "condition", {}, [](const A& a, Writer& out) { out.number(a.gains.condition); }, number().schema,
                "Condition number of the gains at steady state, in their units.")
            .field(
                "pairings", {},
                [](const A& a, Writer& out) { list_of(answer(pairing_contract())).write(a.gains.pairings, out); },
                list_of(answer(pairing_contract())).schema, "The best first.")
            .field(
                "pairing", {}, [](const A& a, Writer& out) { write_inputs(a.gains.pairings[a.chosen].input_of, out); },
                whole_numbers_schema, "The pairing of the controllers: the input of each output, from 1.")
            .field("controllers", &A::controllers, only_answered(list_of(ideal_controller())),
                   "In the order of the outputs.");
        add_figures(d);
        d.field("cost", &A::cost, figure(), "Weighted sum of IAE_load.")
            .field("decoupling", &A::decoupling, maybe(answer(decoupling_contract())), "With a decoupler.")
            .field("manual", {}, write_manual, manual_schema,
                   "may_open: each loop may be put in manual; unstable_in_automatic: sets of loops, from 1, that are "
                   "not stable with the others in manual.")
            .field("F_blt", &A::F, figure(), "Detuning factor of Luyben's tuning.")
            .field("compared", &A::compared, list_of(answer(compared_contract())), "Controllers for comparison.")
            .why_null(kUnstableLoops);
        add_answer_members(d);
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
