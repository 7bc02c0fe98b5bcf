#include "api/contract/reports/reports.h"

namespace tunewright::api {

const std::vector<ReportContract>& report_contracts() {
    static const std::vector<ReportContract> contracts = {
        cost_surface_report(),
        rimc_report(),
        tradeoff_report(),
        emulation_report(),
    };
    return contracts;
}

}  // namespace tunewright::api
