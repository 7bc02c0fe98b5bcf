#include "api/contract/result/optimum_at_ms.h"

#include "api/contract/result/evaluation.h"

namespace tunewright::api {

const Description<OptimumAtMs>& optimum_contract() {
    static const auto description = [] {
        using O = OptimumAtMs;
        Description<O> d("OptimumAtMs", "The least load IAE that a robust PID reaches with this entry's Ms as limit.");
        d.field("IAE", &O::IAE, figure(), "Load IAE of the method robust with both Ms and Mt limited to this Ms.",
                {.unit = "y time"})
            .field("excess_percent", &O::excess_percent, figure(),
                   "How far this entry's load IAE lies above it; below 0 where its filter or its Mt lets it.",
                   {.unit = "%"})
            .why_null("Not known for this entry.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
