// The commands about one loop: from a plant or a record to settings, a report or a program.
#include <algorithm>
#include <tuple>

#include "engine/number_text.h"
#include "engine/tuning/limits.h"
#include "server/cli/command_tree.h"
#include "server/cli/commands.h"

namespace tunewright::server {
void add_output_options(CLI::App& app, OutputWords& words, bool has_table) {
    CLI::Option* json = app.add_flag("--json", words.json, "Compact JSON, even on a terminal");
    CLI::Option* pretty = app.add_flag("--pretty", words.pretty, "JSON with a line for each member");
    json->excludes(pretty);
    if (!has_table) return;
    CLI::Option* table = app.add_flag("--table", words.table, "The short table, also for a file or a pipe");
    table->excludes(json)->excludes(pretty);
}

namespace {

void add_record_options(CLI::App& app, api::CsvRequest& question) {
    app.add_option("--t", question.t, "CSV: heading or number of the time column")->type_name("COLUMN");
    app.add_option("--u", question.u, "CSV: heading or number of the controller output")->type_name("COLUMN");
    app.add_option("--y", question.y, "CSV: heading or number of the measurement")->type_name("COLUMN");
    app.add_option("--r", question.r, "CSV: heading or number of the set point, if there is one")->type_name("COLUMN");
    app.add_option("--mode", question.mode, "CSV: heading or number of the loop's mode, if there is one")
        ->type_name("COLUMN");
    app.add_option("--d", question.d, "CSV: heading or number of a measured disturbance; may be repeated")
        ->type_name("COLUMN")
        ->take_all()
        ->expected(1)
        ->allow_extra_args(false);
    app.add_option("--dt", question.dt, "CSV without times: their spacing")->type_name("TIME");
    app.add_option("--kind", question.kind, "CSV: auto, step, relay or general")->type_name("WORD");
    app.add_option("--model", question.model, "CSV: auto, fopdt, sopdt, sopdt_zero, ipdt or ipdt_lag")
        ->type_name("WORD");
    app.add_option("--u-limits", question.u_limits, "CSV: limits of the actuator, low and high")
        ->expected(2)
        ->type_name("NUMBER");
    app.add_option("--u0", question.u0, "CSV: controller output before the first row")->type_name("NUMBER");
    app.add_option("--y0", question.y0, "CSV: measurement before the first row")->type_name("NUMBER");
    app.add_option("--u-step", question.u_step, "CSV without u: the step of u at the first row, from and to")
        ->expected(2)
        ->type_name("NUMBER");
    app.add_option("--run", question.run, "CSV with several runs: which of them, from 1")->type_name("NUMBER");
    app.add_option("--time-unit", question.time_unit,
                   "Unit of the times of a file, if it gives none or a wrong one; unit of the times of a plant")
        ->type_name("UNIT");
    app.add_option("--answer-unit", question.answer_unit, "Unit of the times of the answer; s if not given")
        ->type_name("UNIT");
}

void add_tune_options(CLI::App& app, TuneCommand& command) {
    app.add_option("file", command.file, "A request as JSON, or a recorded test as CSV; - reads standard input");
    app.add_option("--plant", command.words.plant, "A plant instead of a file: \"2 e^(-3s)/(10s+1)\"")
        ->type_name("TEXT");
    app.add_option("--Ku", command.words.Ku, "Instead of a plant: the gain at which the loop oscillates, with --Pu")
        ->type_name("NUMBER");
    app.add_option("--Pu", command.words.Pu, "The period of that oscillation")->type_name("TIME");
    app.add_option("--K", command.words.K, "The static gain, if it is known")->type_name("NUMBER");
    if (!command.all)
        app.add_option("--method", command.words.methods, "A tuning method; may be repeated (default: robust)")
            ->type_name("ID")
            ->take_all()
            ->expected(1)
            ->allow_extra_args(false);
    app.add_option("--Ms", command.words.Ms,
                   "Limit of Ms and of Mt, in (1, " + text(limits::kMaxMs) + "]; default " + text(limits::kDefaultMs))
        ->type_name("NUMBER");
    app.add_option(
           "--baseline", command.words.baseline,
           "Today's settings in the ideal form: \"Kp Ti Td\"; as control software writes them: \"pidstd(1.5, 120, "
           "20, 10)\"; from-record: as a recorded test shows them")
        ->type_name("TEXT");
    app.add_option("--set", command.words.set,
                   "Any other member of the request, such as evaluate.own_step.target=60; may be repeated")
        ->type_name("MEMBER=VALUE")
        ->take_all()
        ->expected(1)
        ->allow_extra_args(false);
    add_record_options(app, command.words.record);
    CLI::Option* plot = app.add_flag("--plot", command.plot, "The table, and below it a plot of the best responses");
    app.add_option("--svg", command.svg, "Write that plot to this file, as SVG")->type_name("FILE");
    app.add_flag("--with-request", command.with_request,
                 "JSON with request and result, so that code and report can name the plant");
    add_output_options(app, command.output, true);
    plot->excludes(app.get_option("--json"))->excludes(app.get_option("--pretty"));
}

void add_result_options(CLI::App& app, ResultWords& words, const std::string& help_of_request) {
    app.add_option("file", words.file, "A result of tune, or a job as JSON; - reads standard input")->required();
    app.add_option("--controller", words.controller, "Number in the result, from 0 (default: the best)")
        ->type_name("NUMBER");
    app.add_option("--request", words.request, help_of_request)->type_name("FILE");
}

/// Adds an option that is also a parameter of the call, under the same name: --sample-time is sample_time.
void code_word(CLI::App& app, const std::string& name, api::CodeWords& words, const std::string& help) {
    std::string parameter = name;
    std::replace(parameter.begin(), parameter.end(), '-', '_');
    app.add_option_function<std::string>(
           "--" + name, [&words, parameter](const std::string& word) { words.emplace_back(parameter, word); }, help)
        ->type_name("WORD");
}

void add_code_words(CLI::App& app, api::CodeWords& words) {
    code_word(app, "language", words, "st, c, python or arduino");
    code_word(app, "sample-time", words, "Time from one call to the next, in the result's unit of time");
    code_word(app, "integral", words, "backward, forward or trapezoidal");
    code_word(app, "derivative", words,
              "difference, filtered_backward, filtered_forward, filtered_trapezoidal, slope or four_points");
    code_word(app, "slope-samples", words, "Number of sample times that the rule slope spans");
    code_word(app, "form", words, "position or velocity");
    code_word(app, "anti-windup", words, "back_calculation or clamping");
    code_word(app, "tracking-time", words, "Tracking time of back-calculation");
    code_word(app, "u-min", words, "Smallest u");
    code_word(app, "u-max", words, "Largest u");
    code_word(app, "rate-limit", words, "Largest rate of u, per unit of time");
    code_word(app, "bias", words, "u at the operating point");
    code_word(app, "y0", words, "y at the operating point");
    code_word(app, "r2-min", words, "Cascade: smallest set point of the inner loop");
    code_word(app, "r2-max", words, "Cascade: its largest");
    code_word(app, "r2-bias", words, "Cascade: it at the operating point");
    code_word(app, "d0", words, "Feedforward: the disturbance at the operating point");
    code_word(app, "compensator", words, "Feedforward: static, inverse, guzman_hagglund, optimum or given");
}

void add_experiment_words(CLI::App& app, CodeCommand& command) {
    app.add_option_function<std::string>(
           "--experiment",
           [&command](const std::string& word) {
               command.experiment = true;
               command.words.emplace_back("experiment", word);
           },
           "relay or bump: the program of a test that a controller runs by itself; without a result, times in seconds")
        ->type_name("WORD");
    code_word(app, "u-step", command.words, "Test: size of the moves of u");
    code_word(app, "asymmetry", command.words,
              "Relay test: levels u0 + u_step (1 + asymmetry), u0 - u_step (1 - asymmetry)");
    code_word(app, "action", command.words, "Relay test: reverse, direct or find");
    code_word(app, "cycles", command.words, "Relay test: exactly so many cycles");
    code_word(app, "y-move", command.words, "Bump: the step ends when y has moved so far");
    code_word(app, "hysteresis", command.words, "Test: least distance of y from its level at which u moves");
    code_word(app, "y-min", command.words, "Test: y below it stops the test");
    code_word(app, "y-max", command.words, "Test: y above it stops the test");
    code_word(app, "u-safe", command.words, "Test: u after a fault");
    code_word(app, "quiet-time", command.words, "Test: time in which u is held and the noise measured");
    code_word(app, "max-time", command.words, "Test: its longest time");
    code_word(app, "frozen-time", command.words, "Test: y unchanged for longer is a fault");
}

void add_request_command(CommandTree& tree, const std::string& name, const std::string& structure,
                         const std::string& help, const std::string& help_of_file) {
    RequestCommand& words = tree.keep<RequestCommand>();
    words.structure = structure;
    CLI::App& app = tree.add(name, help, [&words] { return answer_request(words); });
    app.add_option("file", words.file, help_of_file)->required();
    add_output_options(app, words.output, true);
}

void add_list_command(CommandTree& tree, const std::string& name, const std::string& help, const std::string& one,
                      int (*action)(const ListCommand&)) {
    ListCommand& words = tree.keep<ListCommand>();
    CLI::App& app = tree.add(name, help, [&words, action] { return action(words); });
    app.add_option("name", words.name, one);
    add_output_options(app, words.output, true);
}

}  // namespace

void add_loop_commands(CommandTree& tree) {
    TuneCommand& tuning = tree.keep<TuneCommand>();
    add_tune_options(tree.add("tune", "Settings for a plant or a recorded test", [&] { return tune(tuning); }), tuning);

    TuneCommand& comparing = tree.keep<TuneCommand>();
    comparing.all = true;
    add_tune_options(
        tree.add("compare", "Settings by every method that applies, ranked", [&] { return tune(comparing); }),
        comparing);

    add_request_command(tree, "range", "", "One setting and a schedule for a whole operating range",
                        "A request with points or equations as JSON; - reads standard input");
    for (const auto& [name, help] : {std::pair{"cascade", "An inner and an outer controller"},
                                     {"level", "A level controller that smooths flows"},
                                     {"feedforward", "A compensator from a measured disturbance"},
                                     {"interaction", "Controllers of two or three loops that disturb each other"},
                                     {"predictor", "A dead-time compensator, and the PID of the same Ms"}})
        add_request_command(tree, name, name, help,
                            "The request of POST /v1/" + std::string(name) + " as JSON; - reads standard input");

    IdentifyCommand& identifying = tree.keep<IdentifyCommand>();
    CLI::App& identify_app =
        tree.add("identify", "A model from a recorded test", [&] { return identify(identifying); });
    identify_app.add_option("file", identifying.file, "CSV, or {record, identify} as JSON; - reads standard input")
        ->required();
    add_record_options(identify_app, identifying.question);
    identify_app.add_flag("--traces", identifying.question.traces,
                          "CSV: include the record and the simulated responses of the models");
    add_output_options(identify_app, identifying.output, true);

    ControllerRecordCommand& asking = tree.keep<ControllerRecordCommand>();
    CLI::App& asking_app = tree.add("controller", "The controller's settings from a record of its loop in automatic",
                                    [&] { return controller_record(asking); });
    asking_app.add_option("file", asking.file, "CSV, or {record, implement} as JSON; - reads standard input")
        ->required();
    add_record_options(asking_app, asking.question);
    add_output_options(asking_app, asking.output, false);

    ScoreCommand& scoring = tree.keep<ScoreCommand>();
    CLI::App& score_app =
        tree.add("score", "A tuning rule against problems with proved bounds", [&] { return score(scoring); });
    CLI::Option* file = score_app.add_option(
        "file", scoring.file, "The request of POST /v1/score as JSON, or a CSV of settings (problem,Kp,Ti,Td)");
    for (const auto& [name, word, help, is_rule] :
         {std::tuple{"--Kp", &scoring.words.Kp, "Formula of Kp, such as T/(2*K*L)", true},
          {"--Ti", &scoring.words.Ti, "Formula of Ti", true},
          {"--Td", &scoring.words.Td, "Formula of Td", true},
          {"--method", &scoring.words.method, "A method in place of formulas, such as simc", true},
          {"--structure", &scoring.words.structure, "pi, pid_tied or pid_fixed", false},
          {"--Ms", &scoring.words.Ms, "Only problems with this limit", false},
          {"--problems", &scoring.words.problems, "Only problems whose names begin so, such as amigo/", false},
          {"--name", &scoring.words.name, "A name for the answer", false}})
        if (CLI::Option* option = score_app.add_option(name, *word, help)->type_name("WORD"); is_rule)
            option->excludes(file);
    add_output_options(score_app, scoring.output, true);

    PlantCommand& typing = tree.keep<PlantCommand>();
    CLI::App& plant_app = tree.add("plant", "A typed plant such as \"2 e^(-3s)/(10s+1)\" as JSON, with its formula",
                                   [&] { return plant(typing); });
    plant_app.add_option("text", typing.text, "The plant; - reads standard input")->required();
    plant_app.add_option("--time-unit", typing.time_unit, "Unit of the times of the answer; s if not given")
        ->type_name("UNIT");
    add_output_options(plant_app, typing.output, false);

    CodeCommand& coding = tree.keep<CodeCommand>();
    CLI::App& code_app =
        tree.add("code", "A controller of a result, or a test, as Structured Text, C, Python or a sketch",
                 [&] { return code(coding); });
    add_result_options(code_app, coding.result, "File of the request, for the head comment and its sample time");
    code_app.get_option("file")->required(false);
    add_code_words(code_app, coding.words);
    add_experiment_words(code_app, coding);

    VerifyCommand& verifying = tree.keep<VerifyCommand>();
    CLI::App& verify_app = tree.add("verify", "Every figure of a result computed again by a second, independent way",
                                    [&] { return verify(verifying); });
    verify_app
        .add_option("file", verifying.result.file,
                    "The output of tune --with-request, or a job; - reads standard input")
        ->required();
    verify_app.add_option("--request", verifying.result.request, "File of the request, if the result is without it")
        ->type_name("FILE");
    add_output_options(verify_app, verifying.output, true);

    ResultWords& proving = tree.keep<ResultWords>();
    CLI::App& proof_app = tree.add("certificate", "The proof of a result with certify, as a file for the checker",
                                   [&] { return certificate(proving); });
    add_result_options(proof_app, proving, "File of the request; it is not needed");

    ResultWords& reporting = tree.keep<ResultWords>();
    CLI::App& report_app =
        tree.add("report", "A controller of a result as a page to print, in HTML", [&] { return report(reporting); });
    add_result_options(report_app, reporting, "File of the request, if the result does not contain it");
}

void add_list_commands(CommandTree& tree) {
    add_list_command(tree, "methods", "The tuning methods with their options", "Id of one entry to print", methods);
    add_list_command(tree, "controllers", "The products for which settings can be converted",
                     "Id of one entry to print", controllers);
    add_list_command(tree, "examples", "Requests to start from", "Id or number of an example to print", examples);
}

}  // namespace tunewright::server
