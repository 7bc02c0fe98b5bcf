#include "api/code/structure_program.h"

#include <algorithm>
#include <complex>
#include <limits>
#include <utility>
#include <vector>

#include "api/code/parameters.h"
#include "api/code/provenance.h"
#include "engine/code/settings.h"
#include "engine/numerics/polynomial_roots.h"
#include "engine/structure/program/loop_programs.h"
#include "engine/structure/program/predictor_program.h"

namespace tunewright::api {
namespace {

using structure::Feedforward;

/// The answer and the parameters of a program, with the controllers, whose times are in the answer's unit.
struct Source {
    const Json& answer;
    const AskedCode& asked;
    std::vector<ParallelPid> controllers;
    double Ts = 0;  ///< s

    SampledPid law(std::size_t k) const {
        SampledPid law = law_of(asked, controllers.at(k));
        law.Ts = Ts;
        return law;
    }
    code::CodeOptions options() const { return options_of(asked, answer); }
    double seconds(const Json& time) const { return time.get<double>() * asked.unit; }
};

Feedforward compensator_of(const Json& compensator, const Source& s) {
    return {.Kf = compensator.at("Kf").get<double>(),
            .Tz = s.seconds(compensator.at("Tz")),
            .Tp = s.seconds(compensator.at("Tp")),
            .Lf = s.seconds(compensator.at("Lf"))};
}

/// Empty without a decoupler.
structure::Decoupling decoupling_of(const Source& s) {
    const Json decoupling = s.answer.value("decoupling", Json());
    structure::Decoupling out;
    if (!decoupling.is_object()) return out;
    for (const Json& row : decoupling.at("D")) {
        out.emplace_back();
        for (const Json& element : row)
            out.back().push_back(element.is_object() ? std::optional(compensator_of(element, s)) : std::nullopt);
    }
    return out;
}

/// Coefficients of a fraction of s in seconds.
structure::Rational rational_of(const Json& fraction, double unit) {
    const auto in_seconds = [unit](std::vector<double> coefficients) {
        double factor = 1;
        for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c, factor *= unit) *c *= factor;
        return coefficients;
    };
    return {in_seconds(fraction.at("num").get<std::vector<double>>()),
            in_seconds(fraction.at("den").get<std::vector<double>>())};
}

structure::PredictorController predictor_of(const Json& answer, double unit) {
    const Json& model = answer.at("model");
    structure::PredictorController out;
    out.C = rational_of(answer.at("controller").at("C"), unit);
    out.F = rational_of(answer.at("controller").at("F"), unit);
    out.model = {.K = model.at("K").get<double>(), .L = model.at("L").get<double>() * unit};
    out.model.integrating = !model.contains("T");
    if (out.model.integrating)
        out.model.K /= unit;
    else
        out.model.T = model.at("T").get<double>() * unit;
    return out;
}

/// The controllers of the answer, in the order in which the programs take them.
Expected<std::vector<ParallelPid>> controllers_in(const Json& answer, Reader& reader) {
    const std::string structure = answer.at("structure");
    if (structure == "level") {
        const Json& design = answer.at("design");
        IdealPid pid{.Kp = -design.at("Kc").get<double>()};
        pid.Ti = design.at("Ti").is_number() ? design.at("Ti").get<double>() : std::numeric_limits<double>::infinity();
        return std::vector{to_parallel(pid)};
    }
    if (structure == "predictor") {
        auto pid = structure::predictor_pid(predictor_of(answer, 1));
        if (!pid) return pid.error();
        return std::vector{*pid};
    }
    std::vector<const Json*> all;
    if (structure == "cascade")
        all = {&answer.at("inner").at("controller"), &answer.at("outer").at("controller")};
    else if (structure == "feedforward")
        all = {&answer.at("feedback")};
    else
        for (const Json& one : answer.at("controllers")) all.push_back(&one);
    std::vector<ParallelPid> out;
    for (const Json* one : all) out.push_back(gains(read_controller(*one, reader)));
    return out;
}

/// The compensator that was asked for, else the chosen one. Null if it cannot be built.
const Json* chosen_compensator(const Json& answer, const CodeQuestion& question) {
    const std::string kind = question.compensator.value_or(answer.at("chosen").get<std::string>());
    for (const Json& variant : answer.at("variants"))
        if (variant.at("kind") == kind && variant.at("compensator").is_object()) return &variant.at("compensator");
    return nullptr;
}

Expected<code::Program> program_of(const Source& s) {
    const std::string structure = s.answer.at("structure");
    const CodeQuestion& question = s.asked.question;
    if (structure == "cascade") {
        code::CodeOptions r2;
        r2.anti_windup = s.options().anti_windup;
        r2.u_min = question.r2_min;
        r2.u_max = question.r2_max;
        r2.bias = question.r2_bias.value_or(0);
        r2.y0 = s.options().y0;
        return structure::cascade_program(s.law(0), s.law(1), s.options(), r2);
    }
    if (structure == "level") return structure::level_program(s.law(0), s.options(), s.answer.value("gap", 0.0));
    if (structure == "predictor")
        return structure::predictor_program(predictor_of(s.answer, s.asked.unit), s.law(0), s.options());
    if (structure == "feedforward") {
        const Json* compensator = chosen_compensator(s.answer, question);
        if (compensator == nullptr)
            return Error{ErrorKind::invalid_argument, "compensator",
                         "The answer has no such compensator that can be built. Choose another."};
        return structure::feedforward_program(s.law(0), compensator_of(*compensator, s), s.options(),
                                              question.d0.value_or(0));
    }
    std::vector<SampledPid> laws;
    for (std::size_t k = 0; k < s.controllers.size(); ++k) laws.push_back(s.law(k));
    return structure::interaction_program(laws, std::vector(laws.size(), s.options()), decoupling_of(s));
}

/// The controller that needs the shortest sample time.
ParallelPid fastest(const AskedCode& asked, const std::vector<ParallelPid>& controllers) {
    const auto proposed = [&](const ParallelPid& one) {
        return code::proposed_sample_time(law_of(asked, one).gains).value_or(std::numeric_limits<double>::infinity());
    };
    return law_of(asked, *std::ranges::min_element(controllers, {}, proposed)).gains;
}

/// Shortest lag of the compensator or of the decoupler, or of the filter of the prediction's error, in seconds;
/// infinite if there is none.
double shortest_lag(const Json& answer, const AskedCode& asked) {
    const std::string structure = answer.at("structure");
    double out = std::numeric_limits<double>::infinity();
    if (structure == "feedforward") {
        const Json* compensator = chosen_compensator(answer, asked.question);
        const double lag = compensator == nullptr ? 0 : compensator->at("Tp").get<double>() * asked.unit;
        if (lag > 0) out = lag;
    }
    if (const Json::json_pointer elements("/decoupling/D"); answer.contains(elements))
        for (const Json& row : answer.at(elements))
            for (const Json& element : row)
                if (const double lag = element.is_object() ? element.at("Tp").get<double>() * asked.unit : 0; lag > 0)
                    out = std::min(out, lag);
    if (structure == "predictor")
        for (const auto& pole : polynomial_roots(predictor_of(answer, asked.unit).F.den))
            if (pole != 0.0) out = std::min(out, 1 / std::abs(pole));
    return out;
}

/// As asked for, else that of the answer's simulation, else as for any program.
std::variant<SampleTime, Problem> sample_time_for(const Json& answer, const Json& request, const AskedCode& asked,
                                                  const std::vector<ParallelPid>& controllers) {
    const Json::json_pointer simulated("/sampled/sample_time");
    if (!asked.question.sample_time && answer.contains(simulated))
        return SampleTime{answer.at(simulated).get<double>() * asked.unit, "as in the simulation of the answer"};
    return sample_time_of(asked, request, fastest(asked, controllers), Json::object(), shortest_lag(answer, asked));
}

code::Provenance provenance_of_structure(const Json& answer, const Json& request) {
    code::Provenance rows = provenance_of(answer, Json::object(), request);
    rows.insert(rows.begin(), {"Structure", answer.at("structure").get<std::string>()});
    for (const Json& conclusion : answer.at("verdict"))
        rows.emplace_back("Verdict", conclusion.at("code").get<std::string>());
    return rows;
}

}  // namespace

std::variant<StructureProgram, Problem> structure_program(const Json& answer, const Json& request,
                                                          const AskedCode& asked) {
    Reader reader;
    const auto controllers = controllers_in(answer, reader);
    if (auto problem = reader.problem()) return *std::move(problem);
    if (!controllers) return to_problem(controllers.error());
    const auto sample_time = sample_time_for(answer, request, asked, *controllers);
    if (const auto* problem = std::get_if<Problem>(&sample_time)) return *problem;
    const auto& chosen = std::get<SampleTime>(sample_time);
    auto program = program_of({answer, asked, *controllers, chosen.seconds});
    if (!program) return to_problem(program.error());
    return StructureProgram{std::move(*program), chosen};
}

std::variant<ControllerCode, Problem> written_structure(const ChosenEntry& found, const CodeWords& words) {
    Reader reader;
    const AskedCode asked = read_asked(words, found, reader);
    if (auto problem = reader.problem()) return *std::move(problem);
    auto made = structure_program(found.result, found.request, asked);
    if (auto* problem = std::get_if<Problem>(&made)) return *std::move(problem);
    const auto& [program, sample_time] = std::get<StructureProgram>(made);
    return printed(program, asked.question.language, provenance_of_structure(found.result, found.request), sample_time);
}

}  // namespace tunewright::api
