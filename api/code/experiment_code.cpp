#include "api/code/experiment_code.h"

#include "api/code/parameters.h"
#include "api/code/provenance.h"
#include "api/contract/device/experiment_question.h"
#include "api/describe/body.h"

namespace tunewright::api {
namespace {

std::variant<ControllerCode, Problem> written(const std::variant<ExperimentQuestion, Problem>& asked) {
    if (const auto* problem = std::get_if<Problem>(&asked)) return *problem;
    const auto& question = std::get<ExperimentQuestion>(asked);
    const auto program = code::experiment_algorithm(question.experiment, question);
    if (!program) return to_problem(program.error());
    return printed(*program, question.language, {}, {question.Ts, "as asked for"});
}

}  // namespace

std::variant<ControllerCode, Problem> experiment_code(std::string_view body) {
    return written(read_body(body, experiment_contract()));
}

std::variant<ControllerCode, Problem> experiment_code(const CodeWords& words) {
    Reader reader;
    ExperimentQuestion question;
    experiment_contract().read(json_of(words, reader), question, reader);
    if (auto problem = reader.problem()) return *std::move(problem);
    return written(question);
}

}  // namespace tunewright::api
