#include "engine/request/plan.h"

#include "engine/request/league.h"

namespace tunewright {
namespace {

Error unknown_method(const std::string& id, const std::string& where) {
    std::string known;
    for (const auto& method : method_registry()) known += method.id + ", ";
    return {ErrorKind::invalid_argument, where + "/method",
            "method is \"" + id + "\"; it must be one of " + known + "or all."};
}

}  // namespace

Expected<std::vector<PlannedRow>> plan_rows(const std::vector<MethodRequest>& requests) {
    std::vector<PlannedRow> planned;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const std::string where = "tune/" + std::to_string(i);
        if (requests[i].of_all()) {
            for (PlannedRow& row : league_rows(requests[i].options)) {
                row.where = where;
                planned.push_back(std::move(row));
            }
            continue;
        }
        const TuningMethod* method = find_method(requests[i].method);
        if (!method) return unknown_method(requests[i].method, where);
        planned.push_back({method, requests[i].options, method->title, {}, where});
    }
    if (planned.empty())
        return Error{ErrorKind::invalid_argument, "tune", "tune is empty; name at least one method, such as robust."};
    return planned;
}

}  // namespace tunewright
