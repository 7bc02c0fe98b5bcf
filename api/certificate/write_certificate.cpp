#include "api/certificate/write_certificate.h"

#include <algorithm>
#include <array>

namespace tunewright::api {
namespace {

void write_head(Writer& out, const Certificate& certificate) {
    out.begin_object();
    out.key("certificate").integer(1);
    out.key("claim").text(
        "No stable controller of the root box with |S| <= Ms and |T| <= Mt has an IAE below the goal.");
    write_problem(certificate.problem, out);
    out.key("goal").number(certificate.lower);
    out.key("root").begin_object();
    out.key("low").numbers(certificate.root.low);
    out.key("high").numbers(certificate.root.high);
    out.end_object();
    out.key("w0").number(certificate.w0);
    out.key("harmonics").integer(certificate.harmonics);
    out.key("phis").begin_array();
    for (const SignFunction& sign : certificate.phis) {
        out.begin_object();
        out.key("first").integer(sign.first);
        out.key("changes").numbers(sign.changes);
        out.end_object();
    }
    out.end_array();
    out.key("leaves").integer(static_cast<long long>(certificate.leaves.size()));
    out.end_object();
}

void write_cuts(Writer& out, const CertificateLeaf& leaf) {
    out.key("cuts").begin_array();
    for (const LimitCut& cut : leaf.cuts) {
        out.begin_object();
        out.key("of").text(cut.complementary ? "T" : "S");
        out.key("omega").number(cut.omega);
        out.key("multiplier").number(cut.multiplier);
        out.end_object();
    }
    out.end_array();
}

void write_leaf(Writer& out, const CertificateLeaf& leaf) {
    out.begin_object();
    out.key("low").numbers(leaf.box.low);
    out.key("high").numbers(leaf.box.high);
    out.key("reason").text(tunewright::to_string(leaf.reason));
    switch (leaf.reason) {
        case LeafReason::sensitivity:
        case LeafReason::complementary: out.key("omega").number(leaf.omega); break;
        case LeafReason::error:
        case LeafReason::unstable:
            out.key("s").begin_array();
            out.number(leaf.s.real());
            out.number(leaf.s.imag());
            out.end_array();
            break;
        case LeafReason::bound: out.key("phi").integer(leaf.phi); [[fallthrough]];
        case LeafReason::empty: write_cuts(out, leaf); break;
    }
    out.end_object();
}

}  // namespace

const char* to_string(CertifiedStructure structure) {
    switch (structure) {
        case CertifiedStructure::pi: return "pi";
        case CertifiedStructure::pid_fixed: return "pid_fixed";
        case CertifiedStructure::pid_tied: return "pid_tied";
    }
    return "pi";
}

void write_problem(const CertificateProblem& problem, Writer& out) {
    out.key("plant").begin_object();
    out.key("num").numbers(problem.plant.num);
    out.key("den").numbers(problem.plant.den);
    out.key("L").number(problem.plant.L);
    out.end_object();
    out.key("structure").text(to_string(problem.structure));
    out.key("Tf").number(problem.Tf);
    out.key("Ms").number(problem.Ms);
    out.key("Mt").number(problem.Mt);
    out.key("upper").number(problem.upper);
    out.key("design").numbers(problem.design);
}

CertificateProblem read_problem(const Json& json) {
    CertificateProblem problem;
    const Json& plant = json.at("plant");
    problem.plant = {plant.at("num").get<std::vector<double>>(), plant.at("den").get<std::vector<double>>(),
                     plant.at("L").get<double>()};
    problem.structure = certified_structure(json.at("structure").get<std::string>());
    problem.Tf = json.at("Tf");
    problem.Ms = json.at("Ms");
    problem.Mt = json.at("Mt");
    problem.upper = json.at("upper");
    problem.design = json.at("design");
    return problem;
}

CertifiedStructure certified_structure(const std::string& name) {
    for (const auto one : {CertifiedStructure::pid_fixed, CertifiedStructure::pid_tied})
        if (name == to_string(one)) return one;
    return CertifiedStructure::pi;
}

std::string write_certificate(const Certificate& certificate) {
    Writer head;
    write_head(head, certificate);
    std::string text = head.take() + '\n';
    for (const CertificateLeaf& leaf : certificate.leaves) {
        Writer line;
        write_leaf(line, leaf);
        text += line.take() + '\n';
    }
    return text;
}

}  // namespace tunewright::api
