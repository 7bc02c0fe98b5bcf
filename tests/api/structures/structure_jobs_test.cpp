// Structures as jobs: the same answers, with report, program, sampled run, settings and records.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "api/code/code.h"
#include "api/code/structure_program.h"
#include "api/report/report.h"
#include "api/report/structure/structure_words.h"
#include "api/report/terminal/terminal.h"
#include "api/service.h"
#include "api/services/structure_service.h"
#include "engine/structure/conclusions.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;
using testing::Not;
using StructureCall = Answer (*)(std::string_view, const RunControl&);

struct StructureCase {
    std::string name, component;
    StructureCall call;
    Json request;
};

std::vector<StructureCase> structure_cases() {
    return {
        {"cascade",
         "CascadeAnswer",
         cascade_call,
         {{"inner", {{"plant", "2 e^(-s)/(4s+1)"}}}, {"outer", {{"plant", "1.5 e^(-8s)/(30s+1)"}}}}},
        {"level",
         "LevelAnswer",
         level_call,
         {{"volume", 12}, {"largest_step", 4}, {"allowed", 1.8}, {"flow_loop", {{"T", 0.4}, {"L", 0.05}}}}},
        {"feedforward",
         "FeedforwardAnswer",
         feedforward_call,
         {{"plant", "1.5 e^(-15s)/(60s+1)"}, {"disturbance", "1/(15s+1)"}, {"feedback", {{"Kp", 1.3333}, {"Ti", 60}}}}},
        {"interaction",
         "InteractionAnswer",
         interaction_call,
         {{"plant", Json::array({Json::array({"12.8 e^(-s)/(16.7s+1)", "-18.9 e^(-3s)/(21s+1)"}),
                                 Json::array({"6.6 e^(-7s)/(10.9s+1)", "-19.4 e^(-3s)/(14.4s+1)"})})},
          {"controllers", Json::array({Json{{"Kp", 0.375}, {"Ti", 8.29}}, Json{{"Kp", -0.075}, {"Ti", 23.6}}})}}},
        {"predictor", "PredictorAnswer", predictor_call, {{"plant", "2 e^(-4s)/(5s+1)"}, {"Ms", 1.6}}}};
}

Json called(const StructureCase& one) {
    const Answer answer = one.call(one.request.dump(), {});
    EXPECT_EQ(answer.status, 200) << answer.body.substr(0, 300);
    const Json value = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(value, one.component), std::vector<std::string>{}) << one.name;
    return value;
}

/// The response of an answer to a step at this input.
Json response_to(const Json& answer, const std::string& of, const std::string& input) {
    for (const Json& one : answer["responses"])
        if (one["of"] == of && one["input"] == input) return one;
    ADD_FAILURE() << "no response of " << of << " to " << input;
    return {};
}

double area_under(const Json& response, std::size_t signal, double target) {
    const Json &t = response["t"], &y = response["signals"][signal]["values"];
    double sum = 0;
    for (std::size_t i = 1; i < t.size(); ++i)
        sum += 0.5 * (t[i].get<double>() - t[i - 1].get<double>()) *
               (std::abs(target - y[i].get<double>()) + std::abs(target - y[i - 1].get<double>()));
    return sum;
}

double largest_of(const Json& answer, const std::string& of, const std::string& loop) {
    for (const Json& curve : answer["sensitivities"]["curves"])
        if (curve["of"] == of && curve["loop"] == loop) {
            const auto values = curve["values"].get<std::vector<double>>();
            return *std::ranges::max_element(values);
        }
    ADD_FAILURE() << "no curve of " << of << " at " << loop;
    return 0;
}

TEST(StructureJobs, AJobHasTheAnswerOfTheCall) {
    for (const StructureCase& one : structure_cases()) {
        SCOPED_TRACE(one.name);
        Json request = one.request;
        request["structure"] = one.name;
        const auto job = prepare_job(request.dump());
        ASSERT_TRUE(std::holds_alternative<PreparedJob>(job)) << std::get<Problem>(job).detail;
        const auto& prepared = std::get<PreparedJob>(job);
        EXPECT_EQ(prepared.subject, JobSubject::structure);
        const JobOutcome outcome = run_job(prepared, {});
        ASSERT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
        EXPECT_EQ(outcome.method, one.name);
        EXPECT_EQ(schema_faults(Json::parse(outcome.outline_json), "JobOutline"), std::vector<std::string>{});
        Json result = Json::parse(outcome.result_json);
        EXPECT_EQ(result["request_hash"], prepared.request_hash);
        result.erase("request_hash");
        EXPECT_EQ(result, called(one));
        const JobOutcome stored = run_job(StoredRequest{prepared.request_json, prepared.request_hash}, {});
        EXPECT_EQ(stored.result_json, outcome.result_json);
        const auto by_name = prepare_structure(one.request.dump(), one.name);
        EXPECT_EQ(std::get<PreparedJob>(by_name).request_hash, prepared.request_hash);
    }
}

TEST(StructureJobs, ARequestOfAnotherStructureIsRefused) {
    const auto refused = [](const Json& request) {
        const auto job = prepare_job(request.dump());
        return std::holds_alternative<Problem>(job) ? Json::parse(to_json(std::get<Problem>(job))).dump() : "";
    };
    EXPECT_THAT(refused({{"structure", "cascad"}}), HasSubstr("cascade, level, feedforward, interaction or predictor"));
    EXPECT_THAT(refused({{"structure", "level"}, {"volume", 1}}), HasSubstr("/largest_step"));
    Json request = structure_cases()[0].request;
    request["structure"] = "level";
    const Answer answer = cascade_call(request.dump(), {});
    EXPECT_EQ(answer.status, 422);
    EXPECT_THAT(answer.body, HasSubstr("it must be cascade"));
}

TEST(StructureJobs, SeriesAgreeWithTheFigures) {
    std::vector<StructureCase> cases = structure_cases();
    for (StructureCase& one : cases) one.request["evaluate"] = {{"points", 2000}};
    const Json cascade = called(cases[0]);
    for (const char* input : {"inner_load", "outer_load"}) {
        EXPECT_NEAR(area_under(response_to(cascade, "design", input), 0, 0) /
                        cascade["performance"][input]["IAE"].get<double>(),
                    1, 0.01);
        EXPECT_NEAR(area_under(response_to(cascade, "single", input), 0, 0) /
                        cascade["single"]["performance"][input]["IAE"].get<double>(),
                    1, 0.01);
    }
    EXPECT_NEAR(area_under(response_to(cascade, "design", "setpoint"), 0, 1) /
                    cascade["performance"]["setpoint"]["IAE"].get<double>(),
                1, 0.01);
    EXPECT_NEAR(largest_of(cascade, "design", "inner"), cascade["inner"]["robustness"]["Ms"].get<double>(), 1e-3);
    EXPECT_NEAR(largest_of(cascade, "design", "outer"), cascade["outer"]["robustness"]["Ms"].get<double>(), 1e-3);
    EXPECT_NEAR(largest_of(cascade, "design", "valve"), cascade["outer"]["robustness"]["Ms_valve"].get<double>(), 1e-3);

    const Json feedforward = called(cases[2]);
    for (const Json& variant : feedforward["variants"])
        if (variant["IAE"].is_number()) {
            EXPECT_NEAR(area_under(response_to(feedforward, variant["kind"], "disturbance"), 0, 0) /
                            variant["IAE"].get<double>(),
                        1, 0.01)
                << variant["kind"];
        }
    const Json interaction = called(cases[3]);
    for (std::size_t j = 0; j < 2; ++j)
        for (std::size_t i = 0; i < 2; ++i)
            EXPECT_NEAR(area_under(response_to(interaction, "design", "load_" + std::to_string(j + 1)), 2 * i, 0) /
                            interaction["IAE_load"][j][i].get<double>(),
                        1, 0.02);
    EXPECT_NEAR(largest_of(interaction, "design", "mu"), interaction["mu"].get<double>(), 1e-3);
    const Json predictor = called(cases[4]);
    EXPECT_NEAR(area_under(response_to(predictor, "design", "load"), 0, 0) / predictor["load"]["IAE"].get<double>(), 1,
                0.01);
    EXPECT_NEAR(area_under(response_to(predictor, "pid", "load"), 0, 0) / predictor["pid_IAE"].get<double>(), 1, 0.01);
    const Json level = called(cases[1]);
    const auto levels = response_to(level, "design", "inflow")["signals"][0]["values"].get<std::vector<double>>();
    EXPECT_NEAR(*std::ranges::max_element(levels) / level["design"]["highest"].get<double>(), 1, 0.06);  // flow loop
}

TEST(StructureJobs, NoPointsMeanNoSeries) {
    for (StructureCase& one : structure_cases()) {
        Json request = one.request;
        request["evaluate"] = {{"points", 0}};
        const Json answer = Json::parse(one.call(request.dump(), {}).body);
        EXPECT_TRUE(answer["responses"].empty());
        EXPECT_TRUE(answer["sensitivities"]["curves"].empty());
    }
}

TEST(StructureJobs, EveryConclusionHasASentenceWithItsFigures) {
    for (const auto code : structure::all_conclusion_codes()) {
        const Json conclusion{{"code", structure::to_string(code)}, {"figures", Json::object()}};
        EXPECT_NE(conclusion_sentence(conclusion, {"s", ""}), structure::to_string(code));
    }
    for (const StructureCase& one : structure_cases())
        for (const Json& conclusion : called(one)["verdict"])
            EXPECT_THAT(conclusion_sentence(conclusion, {"s", ""}), Not(HasSubstr("{"))) << conclusion;
}

TEST(StructureJobs, AnUnknownFigureGivesItsReasonInItsSentence) {
    const Json figures{{"gain", nullptr}, {"why_null", {{"gain", "It is infinite."}}}};
    EXPECT_EQ(conclusion_sentence({{"code", "feedforward-pays"}, {"figures", figures}}, {}),
              "Feedforward pays. It is infinite.");
    EXPECT_EQ(conclusion_sentence({{"code", "level-above-room"}, {"figures", {{"highest", 2}, {"allowed", 1.8}}}},
                                  {"min", "m"}),
              "The level rises by 2 m, above the allowed 1.8 m.");
}

TEST(StructureJobs, AReportATableAndAProgramInEachLanguage) {
    for (const StructureCase& one : structure_cases()) {
        SCOPED_TRACE(one.name);
        const std::string result = called(one).dump();
        const auto report = report_html({result, one.request.dump()}, "", {});
        ASSERT_TRUE(std::holds_alternative<std::string>(report)) << std::get<Problem>(report).detail;
        const auto& page = std::get<std::string>(report);
        EXPECT_THAT(page, HasSubstr(structure_title(one.name)));
        for (const char* part : {"Verdict", "Settings", "Figures", "Responses"}) EXPECT_THAT(page, HasSubstr(part));
        EXPECT_THAT(structure_text(result), HasSubstr("figure"));
        for (const auto& [language, mark] :
             {std::pair{"st", "FUNCTION_BLOCK"}, {"c", "#ifndef"}, {"python", "class"}}) {
            const auto code = structure_code({result, ""}, {{"language", language}, {"u_min", "-9"}, {"u_max", "9"}});
            ASSERT_TRUE(std::holds_alternative<ControllerCode>(code)) << std::get<Problem>(code).detail;
            EXPECT_THAT(std::get<ControllerCode>(code).text, HasSubstr(mark));
            EXPECT_THAT(std::get<ControllerCode>(code).file_name,
                        HasSubstr(language == std::string("st") ? ".st" : "tunewright_"));
        }
        const auto wrong =
            structure_code({result, ""}, {{"language", "c"}, {one.name == "cascade" ? "d0" : "r2_max", "1"}});
        ASSERT_TRUE(std::holds_alternative<Problem>(wrong));
        EXPECT_THAT(to_json(std::get<Problem>(wrong)), HasSubstr("belongs to the code of a"));
    }
}

std::string report_of(const StructureCase& one) {
    const auto page = report_html({called(one).dump(), one.request.dump()}, "", {});
    return std::holds_alternative<std::string>(page) ? std::get<std::string>(page) : std::get<Problem>(page).detail;
}

TEST(StructureReports, TimesOfAConclusionHaveTheirUnit) {
    StructureCase one = structure_cases()[4];
    one.request = {{"plant", "e^(-8s)/(s+1)"},
                   {"units", {{"time", "min"}}},
                   {"controller", {{"C", {{"num", {1.8, 4}}, {"den", {1, 0}}}}, {"F", {{"num", {1}}, {"den", {1}}}}}}};
    const char* limit = " min; 2 min are advisable.";  // a quarter of the dead time
    EXPECT_THAT(report_of(one), HasSubstr(limit));
    EXPECT_THAT(structure_text(called(one).dump()), HasSubstr(limit));
}

TEST(StructureReports, FiguresAreThoseOfTheChosenPairing) {
    StructureCase one = structure_cases()[3];
    one.request["pairing"] = {2, 1};
    one.request["controllers"] = Json::array({Json{{"Kp", -0.01}, {"Ti", 40}}, Json{{"Kp", 0.01}, {"Ti", 40}}});
    const Json answer = called(one);
    double gain = 0;
    for (const StructureFigure& figure : structure_figures(answer))
        if (figure.name == "Relative gain of loop 1") gain = answer.at(Json::json_pointer(figure.pointer));
    EXPECT_NEAR(gain, 1 - 2.009, 1e-3);  // the rows of the relative gains have the sum 1
    EXPECT_THAT(report_of(one), HasSubstr("Controller 1: y1 by u2"));
    EXPECT_THAT(structure_text(answer.dump()), HasSubstr("Controller 2: y2 by u1"));
}

TEST(StructureReports, FiguresHaveTheirUnitsAndNullsTheirReasons) {
    StructureCase cascade = structure_cases()[0];
    EXPECT_THAT(report_of(cascade), HasSubstr("IAE after a load on the outer plant (s)"));
    cascade.request["units"] = {{"time", "min"}, {"y", "degC"}};
    EXPECT_THAT(report_of(cascade), HasSubstr("IAE after a load on the outer plant (°C min)"));

    StructureCase level = structure_cases()[1];
    level.request["aim"] = "no_outflow_overshoot";
    level.request["gap"] = 0.125;
    level.request["units"] = {{"time", "min"}, {"level", "m"}};
    EXPECT_THAT(report_of(level), HasSubstr("Gap in which the controller rests (m)"));
    EXPECT_THAT(report_of(level), HasSubstr("0.125"));

    StructureCase predictor = structure_cases()[4];
    predictor.request = {
        {"plant", {{"type", "fopdt"}, {"K", -1}, {"T", -4}, {"L", 0.5}}}, {"kind", "filtered_smith"}, {"Ms", 1.9}};
    const std::string page = report_of(predictor);
    const std::size_t row = page.find("IAE after a load");
    ASSERT_NE(row, std::string::npos);
    const std::string cells = page.substr(row, page.find("</tr>", row) - row);
    EXPECT_THAT(cells.substr(cells.find("</span>")), HasSubstr("unstable model"));
}

/// The program without the comments in front of it.
std::string class_of(const StructureCase& one, const Json& answer, CodeWords words) {
    words.emplace_back("language", "python");
    const auto code = structure_code({answer.dump(), one.request.dump()}, words);
    if (const auto* problem = std::get_if<Problem>(&code)) return to_json(*problem);
    const std::string& program = std::get<ControllerCode>(code).text;
    return program.substr(std::min(program.find("\nclass "), program.size()));
}

TEST(StructurePrograms, TheyAreTheSimulatedOne) {
    StructureCase one = structure_cases()[0];
    const Json plain = called(one);
    const CodeWords words{{"sample_time", "0.5"}, {"u_min", "-1"},
                          {"u_max", "1"},         {"r2_max", "7"},
                          {"rate_limit", "0.25"}, {"anti_windup", "clamping"},
                          {"bias", "0.75"},       {"derivative", "difference"}};
    const std::string wanted = class_of(one, plain, words);
    one.request["sampled"] = {{"steps", {{"setpoint", 2}}}};
    for (const auto& [name, word] : words) {
        const Json number = Json::parse(word, nullptr, false);
        one.request["sampled"][name] = number.is_number() ? number : Json(word);
    }
    const Json simulated = called(one);
    EXPECT_EQ(class_of(one, simulated, {}), wanted);
    EXPECT_NE(class_of(one, simulated, {{"u_max", "0.5"}}), wanted);
    EXPECT_EQ(class_of(one, simulated, {{"u_max", "1"}, {"sample_time", "0.5"}}), wanted);
    one.request["sampled"]["anti_windup"] = "back_calculation";
    one.request["sampled"]["tracking_time"] = 3;
    EXPECT_EQ(class_of(one, called(one), {{"anti_windup", "clamping"}}), wanted);

    one.request.erase("sampled");
    one.request["implement"] = Json::array({Json{{"sample_time", 0.25}}, Json{{"sample_time", 0.25}}});
    EXPECT_EQ(class_of(one, called(one), {}), class_of(one, plain, {{"sample_time", "0.25"}}));
}

TEST(StructurePrograms, TheProposedSampleTimeResolvesEveryLag) {
    const auto proposed = [](const Json& answer, const char* compensator) {
        AskedCode asked;
        if (*compensator != 0) asked.question.compensator = compensator;
        const auto made = structure_program(answer, Json(), asked);
        return std::holds_alternative<StructureProgram>(made) ? std::get<StructureProgram>(made).sample_time.seconds
                                                              : -1;
    };
    const Json feedforward = called(structure_cases()[2]);
    EXPECT_EQ(proposed(feedforward, "static"), 5);   // a tenth of Ti = 60, rounded down
    EXPECT_EQ(proposed(feedforward, "inverse"), 1);  // a tenth of the disturbance's lag, 15
    StructureCase predictor = structure_cases()[4];
    predictor.request["controller"] = {{"C", {{"num", {2.5, 0.5}}, {"den", {5, 0}}}},
                                       {"F", {{"num", {1}}, {"den", {0.06, 0.5, 1}}}}};  // lags 0.2 and 0.3
    predictor.request.erase("Ms");
    EXPECT_EQ(proposed(called(predictor), ""), 0.02);
}

TEST(StructurePrograms, CommentsOfTheOuterControllerNameItsOutput) {
    const auto code = structure_code({called(structure_cases()[0]).dump(), ""}, {{"language", "st"}});
    const auto& text = std::get<ControllerCode>(code).text;
    const auto count = [&](const std::string& words) {
        int found = 0;
        for (std::size_t at = text.find(words); at != text.npos; at = text.find(words, at + 1)) ++found;
        return found;
    };
    for (const char* words : {"least ", "largest ", "largest change of "})
        for (const char* name : {"u", "r2"}) EXPECT_GE(count(std::string(words) + name + " "), 1) << words << name;
}

TEST(StructureJobs, ASampledRunComesCloseToTheContinuousLoops) {
    for (StructureCase one : structure_cases()) {
        SCOPED_TRACE(one.name);
        one.request["sampled"] = {{"sample_time", one.name == "feedforward" || one.name == "interaction" ? 0.1 : 0.02}};
        const Json answer = called(one);
        ASSERT_TRUE(answer.contains("sampled"));
        const Json& sampled = answer["sampled"];
        if (one.name == "cascade") {
            EXPECT_NEAR(sampled["Ms"]["inner"].get<double>(), answer["inner"]["robustness"]["Ms"].get<double>(), 0.02);
            EXPECT_NEAR(sampled["Ms"]["valve"].get<double>(), answer["outer"]["robustness"]["Ms_valve"].get<double>(),
                        0.02);
            for (const Json& response : sampled["responses"])
                EXPECT_NEAR(response["figures"][0]["IAE"].get<double>() /
                                answer["performance"][response["input"].get<std::string>()]["IAE"].get<double>(),
                            1, 0.02);
        }
        if (one.name == "predictor") {
            EXPECT_NEAR(sampled["Ms"]["loop"].get<double>(), 1.6, 0.02);
        }
        if (one.name == "level") {
            EXPECT_NEAR(
                sampled["responses"][0]["figures"][0]["peak"].get<double>() / answer["design"]["highest"].get<double>(),
                1, 0.06);
        }
        if (one.name == "feedforward") {
            EXPECT_NEAR(sampled["responses"][0]["figures"][0]["IAE"].get<double>() /
                            answer["variants"].back()["IAE"].get<double>(),
                        1, 0.02);
        }
    }
}

TEST(StructureJobs, ASampledRunKeepsTheLimits) {
    StructureCase one = structure_cases()[0];
    one.request["sampled"] = {{"sample_time", 0.5}, {"u_min", -1}, {"u_max", 1}, {"steps", {{"setpoint", 2}}}};
    const Json answer = called(one);
    bool reached = false;
    for (const Json& response : answer["sampled"]["responses"])
        for (const Json& signal : response["signals"])
            if (signal["name"] == "u")
                for (const Json& value : signal["values"]) {
                    EXPECT_LE(std::abs(value.get<double>()), 1 + 1e-12);
                    reached = reached || std::abs(value.get<double>()) > 0.999;
                }
    EXPECT_TRUE(reached);
    one.request["sampled"]["steps"] = {{"inflow", 2}};
    EXPECT_THAT(one.call(one.request.dump(), {}).body, HasSubstr("/sampled/steps/inflow"));
    one.request["sampled"] = {{"form", "velocity"}};
    EXPECT_THAT(one.call(one.request.dump(), {}).body, HasSubstr("/sampled/form"));
}

TEST(StructureJobs, SettingsOfAProductForEachController) {
    StructureCase one = structure_cases()[0];
    const Json spans{{"product", "emerson_deltav_standard"}, {"y_span", {0, 100}}, {"u_span", {0, 100}}};
    one.request["units"] = {{"time", "s"}};
    one.request["implement"] = Json::array({spans, spans});
    one.request["implement"][1]["y_span"] = {0, 400};
    const Json answer = called(one);
    ASSERT_EQ(answer["settings"].size(), 2U);
    EXPECT_EQ(answer["settings"][0]["loop"], "inner");
    const double inner = answer["inner"]["controller"]["Kp"], outer = answer["outer"]["controller"]["Kp"];
    EXPECT_NEAR(answer["settings"][0]["typing"]["settings"]["GAIN"].get<double>(), inner, 0.01 * inner);
    EXPECT_NEAR(answer["settings"][1]["typing"]["settings"]["GAIN"].get<double>(), 4 * outer, 0.01 * 4 * outer);
    one.request["implement"] = {{"product", "no such"}};
    EXPECT_THAT(one.call(one.request.dump(), {}).body, HasSubstr("/implement/product"));
}

TEST(StructureJobs, AProductForAllOrOneForEachController) {
    const auto refusal = [](std::size_t place, std::size_t entries) {
        StructureCase one = structure_cases()[place];
        one.request["implement"] = Json::array();
        for (std::size_t i = 0; i < entries; ++i) one.request["implement"].push_back({{"sample_time", 0.1}});
        const Answer answer = one.call(one.request.dump(), {});
        return answer.status == 200 ? "" : answer.body;
    };
    const std::size_t controllers[] = {2, 1, 1, 2, 1};
    for (std::size_t place = 0; place < 5; ++place)
        for (std::size_t entries = 1; entries <= 3; ++entries) {
            SCOPED_TRACE(structure_cases()[place].name + " " + std::to_string(entries));
            if (entries == 1 || entries == controllers[place])
                EXPECT_EQ(refusal(place, entries), "");
            else
                EXPECT_THAT(refusal(place, entries), HasSubstr("\"/implement\""));
        }
}

TEST(StructureJobs, FaultsOfASampledProgramNameItsMembers) {
    StructureCase cascade = structure_cases()[0];
    cascade.request["sampled"] = {{"r2_min", 5}, {"r2_max", 1}};
    const std::string body = cascade.call(cascade.request.dump(), {}).body;
    EXPECT_THAT(body, HasSubstr("\"/sampled/r2_max\""));
    EXPECT_THAT(body, HasSubstr("r2_max must be > r2_min"));
    for (const std::size_t place : {0, 2, 3, 4}) {
        StructureCase one = structure_cases()[place];
        one.request["sampled"] = {{"sample_time", 1e-9}};
        EXPECT_THAT(one.call(one.request.dump(), {}).body, HasSubstr("\"/sampled/sample_time\"")) << one.name;
    }
}

/// A first-order lag with dead time, called every 0.5.
std::vector<double> lagged(const std::vector<double>& u, double K, double T, double L) {
    std::vector<double> y(u.size(), 0.0);
    const std::size_t late = static_cast<std::size_t>(std::lround(L / 0.5));
    const double a = std::exp(-0.5 / T);
    for (std::size_t k = 0; k + 1 < u.size(); ++k) y[k + 1] = a * y[k] + K * (1 - a) * (k >= late ? u[k - late] : 0);
    return y;
}

std::vector<double> steps_at(std::initializer_list<std::pair<std::size_t, double>> steps) {
    std::vector<double> u(1600, 0.0);
    for (const auto& [from, value] : steps) std::fill(u.begin() + std::ptrdiff_t(from), u.end(), value);
    return u;
}

Json record_of(const std::vector<double>& u, const std::vector<double>& d, const std::vector<double>& y) {
    std::vector<double> t, measured = y;
    for (std::size_t k = 0; k < u.size(); ++k) {
        t.push_back(0.5 * double(k));
        measured[k] += 0.01 * std::sin(37.0 * double(k) * double(k));
    }
    return {{"t", t}, {"u", u}, {"y", measured}, {"d", Json::array({Json{{"name", "second"}, {"values", d}}})}};
}

TEST(StructureRecords, OneRecordGivesBothPlantsOfACascade) {
    const auto u = steps_at({{100, 5}, {700, -3}, {1200, 2}}), y2 = lagged(u, 2, 4, 1);
    std::vector<double> moving = y2;  // between its samples
    for (std::size_t k = 0; k + 1 < moving.size(); ++k) moving[k] = (y2[k] + y2[k + 1]) / 2;
    const auto y1 = lagged(moving, 1.5, 30, 8);
    const Json request{{"record", record_of(u, y2, y1)}};
    const Answer answer = cascade_call(request.dump(), {});
    ASSERT_EQ(answer.status, 200) << answer.body.substr(0, 300);
    const Json value = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(value, "CascadeAnswer"), std::vector<std::string>{});
    ASSERT_EQ(value["identified"].size(), 2U);
    const Json &inner = value["identified"][0]["model"]["plant"], &outer = value["identified"][1]["model"]["plant"];
    EXPECT_NEAR(inner["K"].get<double>(), 2, 0.02);
    EXPECT_NEAR(outer["K"].get<double>(), 1.5, 0.02);
    EXPECT_NEAR(outer["L"].get<double>(), 8, 0.2);
    const Json exact = called(structure_cases()[0]);
    EXPECT_NEAR(value["outer"]["controller"]["Kp"].get<double>(), exact["outer"]["controller"]["Kp"].get<double>(),
                0.03);

    Json without = request;
    without["record"].erase("d");
    EXPECT_THAT(cascade_call(without.dump(), {}).body, HasSubstr("measurement of the inner loop"));
    Json twice = request;
    twice["inner"] = {{"plant", "1/(s+1)"}};
    EXPECT_THAT(cascade_call(twice.dump(), {}).body, HasSubstr("/inner"));
    EXPECT_THAT(cascade_call("{}", {}).body, HasSubstr("plant is missing"));
}

TEST(StructureRecords, AMeasuredDisturbanceGivesItsPath) {
    const auto u = steps_at({{100, 5}, {800, -3}}), d = steps_at({{400, 4}, {1200, -2}});
    const auto of_u = lagged(u, 1.5, 60, 15), of_d = lagged(d, 1, 15, 0);
    std::vector<double> y(u.size());
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = of_u[k] + of_d[k];
    Json request{{"record", record_of(u, d, y)}, {"feedback", {{"tune", {{"controller", "PI"}}}}}};
    const Answer answer = feedforward_call(request.dump(), {});
    ASSERT_EQ(answer.status, 200) << answer.body.substr(0, 300);
    const Json value = Json::parse(answer.body);
    EXPECT_NEAR(value["variants"][1]["compensator"]["Kf"].get<double>(), 1 / 1.5, 0.01);
    EXPECT_NEAR(value["late"].get<double>(), 15, 0.5);
    request["record"] = record_of(u, d, of_u);
    EXPECT_THAT(feedforward_call(request.dump(), {}).body, HasSubstr("/record"));
}

TEST(StructureRecords, RecordsOfEachOutputGiveTheMatrix) {
    const auto u1 = steps_at({{100, 1}, {800, -1}}), u2 = steps_at({{450, -1}, {1200, 1}});
    Json request{{"records", Json::array()}, {"controllers", structure_cases()[3].request["controllers"]}};
    for (const auto& [a, b] : {std::pair{lagged(u1, 12.8, 16.7, 1), lagged(u2, -18.9, 21, 3)},
                               std::pair{lagged(u1, 6.6, 10.9, 7), lagged(u2, -19.4, 14.4, 3)}}) {
        std::vector<double> y(a.size());
        for (std::size_t k = 0; k < y.size(); ++k) y[k] = a[k] + b[k];
        request["records"].push_back(record_of(u1, u2, y));
    }
    const Answer answer = interaction_call(request.dump(), {});
    ASSERT_EQ(answer.status, 200) << answer.body.substr(0, 300);
    const Json value = Json::parse(answer.body);
    EXPECT_NEAR(value["rga"][0][0].get<double>(), 2.009, 0.02);
    EXPECT_NEAR(value["mu"].get<double>(), 1.949, 0.03);
    EXPECT_THAT(interaction_call("{}", {}).body, HasSubstr("records, one of each output"));
}

}  // namespace
}  // namespace tunewright::api
