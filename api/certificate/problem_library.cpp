#include "api/certificate/problem_library.h"

#include <utility>

#include "api/certificate/write_certificate.h"
#include "api/embed/files.h"
#include "api/json/json.h"

namespace tunewright::api {
namespace {

score::Problem problem_of(const Json& entry) {
    score::Problem problem;
    problem.name = entry.at("name");
    problem.plant = TransferFunction{.num = entry.at("num").get<std::vector<double>>(),
                                     .den = entry.at("den").get<std::vector<double>>(),
                                     .L = entry.at("L").get<double>()};
    problem.structure = certified_structure(entry.at("structure").get<std::string>());
    problem.Tf = entry.value("Tf", 0.0);
    problem.Ms = entry.at("Ms");
    problem.Mt = entry.at("Mt");
    problem.upper = entry.at("upper");
    problem.lower = entry.at("lower");
    return problem;
}

}  // namespace

const std::vector<score::Problem>& problem_library() {
    static const std::vector<score::Problem> library = [] {
        std::vector<score::Problem> out;
        const Json file = Json::parse(embedded_file("../bench/problems/problems.json"));
        for (const Json& entry : file.at("problems")) out.push_back(problem_of(entry));
        return out;
    }();
    return library;
}

}  // namespace tunewright::api
