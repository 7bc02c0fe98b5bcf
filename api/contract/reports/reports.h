// Reports of methods in addition to their controllers, as entries carry them: one contract file per report, listed in
// reports.cpp.
#pragma once

#include <string>
#include <vector>

#include "api/describe/description.h"
#include "engine/tuning/method/method_report.h"

namespace tunewright::api {

struct ReportContract {
    std::string field;     ///< its name in the entry
    std::string sentence;  ///< its description
    Callable<bool(const MethodReport&)> is;
    Callable<void(const MethodReport&, Writer&)> write;
    SchemaOf schema;
    bool last = false;  ///< at the end of the entry, after the comparison with the optimum
};

template <class Report>
ReportContract report_contract(std::string field, const Description<Report>& description, std::string sentence,
                               bool last = false) {
    const Description<Report>* what = &description;
    return {std::move(field),
            std::move(sentence),
            [](const MethodReport& report) { return dynamic_cast<const Report*>(&report) != nullptr; },
            [what](const MethodReport& report, Writer& out) { what->write(dynamic_cast<const Report&>(report), out); },
            [what](SchemaBook& book) { return what->schema(book); },
            last};
}

ReportContract cost_surface_report();
ReportContract certificate_report();
ReportContract frontier_report();
ReportContract rimc_report();
ReportContract tradeoff_report();
ReportContract emulation_report();

/// In their order within an entry.
const std::vector<ReportContract>& report_contracts();

}  // namespace tunewright::api
