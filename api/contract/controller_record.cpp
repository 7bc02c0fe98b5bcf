#include "api/contract/controller_record.h"

#include "api/contract/controller.h"
#include "api/contract/request.h"
#include "api/contract/result/evaluation.h"
#include "api/describe/codec.h"

namespace tunewright::api {

const Description<ControllerRecordRequest>& controller_record_request_contract() {
    static const auto description = [] {
        using R = ControllerRecordRequest;
        Description<R> d("ControllerRecordRequest", "A record of a closed loop in automatic.");
        add_labels(d);
        d.field("record", &R::record, maybe(object(record_contract())),
                "The record: u, y and, if it is known, the set point r.", {.required = true})
            .field("sample_time", &R::sample_time, maybe(number({.exclusive_minimum = 0})),
                   "Sample time of the controller, if it is known (default: that of implement): rows further apart "
                   "show Kp "
                   "less exactly without it.",
                   {.unit = "time"})
            .field("implement", &R::implement, maybe(object(implement_contract())),
                   "The user's own controller. Its integral's rule applies, its filter if that fits as well as others; "
                   "with "
                   "a product the answer has its settings too.")
            .check([](const Json&, R& request, Reader& reader) {
                const Units units = request.units.value_or(Units{});
                if (request.implement) {
                    if (request.implement->product && !seconds_per_time(units.time_or_default(), reader)) return;
                    const Reader::At at(reader, "implement");
                    request.device = device_of(*request.implement, units.time_or_default(), reader);
                    if (request.device) check_needs(*request.device, reader);
                }
                const Reader::At at(reader, "record");
                request.read = resolve(std::move(*request.record), units, reader);
            })
            .example({{"record", {{"csv", "t,sp,op,pv\n0,50,40,50\n..."}, {"columns", {{"r", "sp"}}}}}});
        return d;
    }();
    return description;
}

namespace {

const Description<IdentifiedController>& identified_controller_contract() {
    static const auto description = [] {
        using C = IdentifiedController;
        Description<C> d("IdentifiedController", "The settings of the controller that moved u.");
        d.field(
             "controller", {},
             [](const C& found, Writer& out) { controller_contract().write(Controller(found.pid), out); },
             [](SchemaBook& book) { return one_of(controller_contract()).schema(book); },
             "In the ideal form, of a program with the backward rule, or that of implement. Terms that are 0 within "
             "their errors are left out.",
             {.required = true})
            .field("standard_errors", &C::standard_errors, numbers_by_name("Kp, Ti, Td, Tf or b."),
                   "One standard deviation of each parameter that the controller has, and of a known b.",
                   {.required = true})
            .field("certain", &C::certain, boolean(),
                   "True if the settings are known well enough to be taken for today's without a question; otherwise "
                   "the warning controller-uncertain says how well they are known.",
                   {.required = true})
            .field("sample_time", &C::sample_time, only_answered(maybe(number())),
                   "Of the controller: as given, or as the record shows it; left out if it does not.", {.unit = "time"})
            .field("delay", &C::delay, only_answered(number()), "Time from y to the u that answers it in the record.",
                   {.unit = "time"})
            .field("b_known", &C::b_known, boolean(),
                   "True if the set point moves enough in automatic to tell b = 0 from b = 1; otherwise b and c are "
                   "not identified.")
            .field("explained", &C::explained, only_answered(number()),
                   "Share of the moves of u that the settings explain, 0 to 1.")
            .field("rows", &C::rows, only_answered(integer(0, 1 << 30)), "Rows used.")
            .field("manual_rows", &C::manual_rows, only_answered(integer(0, 1 << 30)),
                   "Rows left out because u stands still: in manual, or moves that rounding hides.")
            .field("limited_rows", &C::limited_rows, only_answered(integer(0, 1 << 30)),
                   "Rows left out at a limit of u.")
            .field("odd_rows", &C::odd_rows, only_answered(integer(0, 1 << 30)),
                   "Rows left out because u does not follow the settings there.")
            .field("warnings", &C::warnings, list_of(object(warning_contract())), "Remarks.", {.required = true});
        return d;
    }();
    return description;
}

}  // namespace

const Description<ControllerRecordAnswer>& controller_record_answer_contract() {
    static const auto description = [] {
        using A = ControllerRecordAnswer;
        Description<A> d("ControllerRecordAnswer", "Today's settings of the loop.");
        d.field("identified", &A::found, maybe(answer(identified_controller_contract())), "From the record.")
            .field("not_identified", &A::not_identified, maybe(words()),
                   "Instead of identified: the reason why the record does not show the settings.")
            .field("typing", &A::typing, maybe(answer(settings_answer_contract())),
                   "The same as settings of the product of implement.")
            .field("not_typed", &A::not_typed, maybe(words()),
                   "Instead of typing: the reason why the product cannot have these settings.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
