// What methods tell beside their controllers, as entries carry it: one contract file a report, listed in reports.cpp.
#pragma once

#include <string>
#include <vector>

#include "api/describe/description.h"
#include "engine/tuning/method/method_report.h"

namespace tunewright::api {

struct ReportContract {
    std::string field;     ///< of the entry
    std::string sentence;  ///< what it is
    Callable<bool(const MethodReport&)> is;
    Callable<void(const MethodReport&, Writer&)> write;
    SchemaOf schema;
    bool last = false;  ///< stands at the entry's end, after the comparison with the optimum
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
ReportContract frontier_report();
ReportContract rimc_report();
ReportContract tradeoff_report();
ReportContract emulation_report();

/// In the order in which an entry has them.
const std::vector<ReportContract>& report_contracts();

}  // namespace tunewright::api
