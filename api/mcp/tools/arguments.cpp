#include "api/mcp/tools/arguments.h"

#include "api/contract/controller.h"

namespace tunewright::api::mcp {
namespace {

constexpr std::size_t kMaxId = 200;
constexpr int kMaxIndex = 1000;

}  // namespace

const Description<JobQuestion>& job_question_contract() {
    static const auto description = [] {
        Description<JobQuestion> d("JobQuestion", "Which job.");
        d.field("job", &JobQuestion::job, maybe(text(kMaxId)),
                "Its id, from the answer of a tool. Left out: the newest jobs.");
        return d;
    }();
    return description;
}

const Description<ProductQuestion>& product_question_contract() {
    static const auto description = [] {
        Description<ProductQuestion> d("ProductQuestion", "Which products.");
        d.field("search", &ProductQuestion::search, maybe(text(kMaxId)),
                "Only products with this text in id, maker, name or family, such as deltav.")
            .field("product", &ProductQuestion::product, maybe(text(kMaxId)),
                   "One product in full: its law, and each parameter with unit and formula.");
        return d;
    }();
    return description;
}

const Description<MethodQuestion>& method_question_contract() {
    static const auto description = [] {
        Description<MethodQuestion> d("MethodQuestion", "Which methods.");
        d.field("method", &MethodQuestion::method, maybe(text(kMaxId)),
                "One method in full: its formula, validity, source and options. Left out: the list.");
        return d;
    }();
    return description;
}

const Description<SettingsQuestion>& settings_question_contract() {
    static const auto description = [] {
        Description<SettingsQuestion> d("SettingsQuestion", "Which product.");
        d.field("product", &SettingsQuestion::product, text(kMaxId), "Id of the product, from list_products.",
                {.required = true});
        return d;
    }();
    return description;
}

const Description<ProgramSubject>& program_subject_contract() {
    static const auto description = [] {
        using S = ProgramSubject;
        Description<S> d("ProgramSubject", "The controller of a program.");
        d.field("job", &S::job, maybe(text(kMaxId)), "Id of the job whose controller is written, or give controller.")
            .field("index", &S::index, maybe(integer(0, kMaxIndex)), "Its number in the job; left out: the best.")
            .field("controller", &S::controller, maybe(one_of(controller_contract())),
                   "The controller, instead of a job.")
            .field("units", &S::units, maybe(object(units_contract())), "Labels of the units of the given controller.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api::mcp
