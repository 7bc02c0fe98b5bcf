#include "api/contract/reports/reports.h"

#include "engine/tuning/robust/robust.h"

namespace tunewright::api {
namespace {

const Description<CostSurface>& surface_contract() {
    static const auto description = [] {
        Description<CostSurface> d("CostSurface", "The least cost over the (Ti, Td) plane.");
        d.field("Ti", &CostSurface::Ti, trace(), "Integral times.", {.unit = "time"})
            .field("Td", &CostSurface::Td, trace(), "Derivative times.", {.unit = "time"})
            .field(
                "cost", {},
                [](const CostSurface& surface, Writer& out) {
                    out.begin_array();
                    for (const auto& row : surface.cost) {
                        out.begin_array();
                        for (const auto& cost : row) cost ? out.trace_number(*cost) : out.null();
                        out.end_array();
                    }
                    out.end_array();
                },
                [](SchemaBook&) {
                    return Json{{"type", "array"},
                                {"items", {{"type", "array"}, {"items", {{"type", {"number", "null"}}}}}}};
                },
                "cost[i][j] belongs to Ti[i] and Td[j]; null if no gain keeps the limits.");
        return d;
    }();
    return description;
}

}  // namespace

ReportContract cost_surface_report() {
    return report_contract("surface", surface_contract(), "Cost over the (Ti, Td) plane, if requested.");
}

const std::vector<ReportContract>& report_contracts() {
    static const std::vector<ReportContract> contracts = {
        cost_surface_report(), certificate_report(), frontier_report(),
        rimc_report(),         tradeoff_report(),    emulation_report(),
    };
    return contracts;
}

}  // namespace tunewright::api
