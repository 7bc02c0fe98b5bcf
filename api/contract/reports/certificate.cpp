#include "api/contract/reports/reports.h"

#include "api/certificate/write_certificate.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright::api {
namespace {

/// (k, ki), and kd or Td for a PID.
void write_corner(const Certificate& c, const std::array<double, 3>& corner, Writer& out) {
    out.begin_object();
    out.key("k").number(corner[0]);
    out.key("ki").number(corner[1]);
    if (c.problem.structure != CertifiedStructure::pi)
        out.key(c.problem.structure == CertifiedStructure::pid_tied ? "Td" : "kd").number(corner[2]);
    out.end_object();
}

Json corner_schema() {
    const Json number{{"type", "number"}};
    return {{"type", "object"},
            {"properties", {{"k", number}, {"ki", number}, {"kd", number}, {"Td", number}}},
            {"required", {"k", "ki"}}};
}

const Description<CertificateReport>& certificate_contract() {
    static const auto description = [] {
        using R = CertificateReport;
        Description<R> d(
            "Certificate",
            "A proof, with rounding, that no stable controller of the root box within the limits has a load "
            "IAE below `lower`: docs/proof.md.");
        const auto number = [](auto member) {
            return [member](const R& r, Writer& out) { out.number(r.certificate.*member); };
        };
        const SchemaOf plain = [](SchemaBook&) { return Json{{"type", "number"}}; };
        d.field(
             "upper", {}, [](const R& r, Writer& out) { out.number(r.certificate.problem.upper); }, plain,
             "The load IAE of this controller, after a unit step.")
            .field("lower", {}, number(&Certificate::lower), plain, "The proven bound.")
            .field("gap", {}, number(&Certificate::gap), plain, "(upper - lower)/upper.")
            .field("asked_gap", {}, number(&Certificate::asked_gap), plain, "The gap that was asked for.")
            .field(
                "complete", {}, [](const R& r, Writer& out) { out.boolean(r.certificate.complete); },
                [](SchemaBook&) {
                    return Json{{"type", "boolean"}};
                },
                "True: the whole root box is proved to the gap that was asked for; else the search was stopped or has "
                "reached its limit.")
            .field(
                "root", {},
                [](const R& r, Writer& out) {
                    out.begin_object();
                    out.key("low");
                    write_corner(r.certificate, r.certificate.root.low, out);
                    out.key("high");
                    write_corner(r.certificate, r.certificate.root.high, out);
                    out.end_object();
                },
                [](SchemaBook&) {
                    return Json{{"type", "object"},
                                {"properties", {{"low", corner_schema()}, {"high", corner_schema()}}},
                                {"required", {"low", "high"}}};
                },
                "The controllers that are compared, in gains of C = k + ki/s and so on.")
            .field(
                "boxes", {}, [](const R& r, Writer& out) { out.integer(r.certificate.boxes); },
                [](SchemaBook&) {
                    return Json{{"type", "integer"}};
                },
                "Boxes that the search has visited.")
            .field(
                "problem", {},
                [](const R& r, Writer& out) {
                    out.begin_object();
                    write_problem(r.certificate.problem, out);
                    out.end_object();
                },
                [](SchemaBook&) {
                    const Json one{{"type", "number"}}, several{{"type", "array"}, {"items", one}};
                    return Json{{"type", "object"},
                                {"properties",
                                 {{"plant",
                                   {{"type", "object"},
                                    {"properties", {{"num", several}, {"den", several}, {"L", one}}},
                                    {"required", {"num", "den", "L"}}}},
                                  {"structure", {{"type", "string"}, {"enum", {"pi", "pid_fixed", "pid_tied"}}}},
                                  {"Tf", one},
                                  {"Ms", one},
                                  {"Mt", one},
                                  {"upper", one},
                                  {"design", several}}},
                                {"required", {"plant", "structure", "Tf", "Ms", "Mt", "upper", "design"}}};
                },
                "What is proved, as in the certificate's file: docs/proof.md.")
            .field("seconds", {}, [](const R& r, Writer& out) { out.number(r.seconds); }, plain, "Computing time.",
                   {.unit = "s"});
        return d;
    }();
    return description;
}

}  // namespace

ReportContract certificate_report() {
    return report_contract("certificate", certificate_contract(),
                           "With certify: how much better any controller could be.");
}

}  // namespace tunewright::api
