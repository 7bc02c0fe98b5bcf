#include "server/cli/verify_table.h"

#include <algorithm>
#include <map>
#include <string>

#include "api/report/terminal/columns.h"
#include "engine/number_text.h"

namespace tunewright::server {

std::string verify_table(const api::VerifyAnswer& answer) {
    struct Differences {
        int count = 0;
        double largest = 0, allowed = 0;
    };
    std::map<std::string, Differences> kinds;
    api::Columns wrong({"figure", "given", "found", "difference", "allowed"}, 1);
    for (const api::VerifiedFigure& one : answer.figures) {
        Differences& kind = kinds[one.figure];
        ++kind.count;
        kind.largest = std::max(kind.largest, one.difference.value_or(0));
        kind.allowed = std::max(kind.allowed, one.allowed);
        if (!one.agrees)
            wrong.row({one.where, one.given.dump(), one.found.dump(), one.difference ? text(*one.difference, 3) : "-",
                       text(one.allowed, 3)});
    }
    api::Columns all({"figure", "compared", "largest difference", "allowed"}, 1);
    for (const auto& [name, kind] : kinds)
        all.row({name, std::to_string(kind.count), text(kind.largest, 2), text(kind.allowed, 2)});
    const int differing = answer.differing();
    std::string out = std::to_string(answer.figures.size()) + " figures compared, " + std::to_string(differing) +
                      (differing == 1 ? " differs.\n" : " differ.\n");
    if (!kinds.empty()) out += "\n" + all.text();
    if (differing > 0) out += "\n" + wrong.text();
    if (!answer.not_verified.empty()) out += "\nNot verified:\n";
    for (const api::UnverifiedPart& one : answer.not_verified) out += "  " + one.where + ": " + one.why + "\n";
    return out;
}

}  // namespace tunewright::server
