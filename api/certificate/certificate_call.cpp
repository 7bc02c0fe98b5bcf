#include "api/certificate/certificate_call.h"

#include "api/certificate/write_certificate.h"

namespace tunewright::api {
namespace {

Problem no_certificate() {
    Problem problem{404, "not-found", "There is no such thing", {}, {}, {}};
    problem.detail =
        "This controller has no certificate. Ask for one: the method robust with certify, for example "
        "{\"method\": \"robust\", \"certify\": {\"gap\": 0.01}}.";
    return problem;
}

std::variant<std::string, Problem> written(const Json& entry, const RunControl& control) {
    const auto found = entry.find("certificate");
    if (found == entry.end() || !found->is_object()) return no_certificate();
    const CertificateProblem problem = read_problem(found->at("problem"));
    CertifyOptions options{.gap = found->at("asked_gap").get<double>(), .reach = {}};
    options.keep_leaves = true;
    const auto certificate = certify(problem, options, control);
    if (!certificate) return to_problem(certificate.error());
    if (control.stop.stop_requested())
        return to_problem(Error{ErrorKind::timeout, "", "The certificate was not finished."});
    return write_certificate(*certificate);
}

}  // namespace

std::variant<std::string, Problem> certificate_file(const ResultSource& source, std::string_view index,
                                                    const RunControl& control) {
    try {
        const auto chosen = choose_entry(source, index);
        if (const auto* problem = std::get_if<Problem>(&chosen)) return *problem;
        return written(std::get<ChosenEntry>(chosen).entry(), control);
    } catch (const Json::exception&) {
        return not_a_result();
    }
}

}  // namespace tunewright::api
