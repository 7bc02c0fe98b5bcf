#include "api/contract/result/verify_call.h"

#include <algorithm>

namespace tunewright::api {
namespace {

Codec<Json> any_object() {
    Codec<Json> codec;
    codec.read = [](const Json& value, Json& target, Reader& reader) {
        if (value.is_object())
            target = value;
        else
            reader.fault(reader.name() + " is " + kind_of(value) + "; it must be an object.");
    };
    codec.write = [](const Json& value, Writer& out) { out.raw(value.dump()); };
    codec.schema = [](SchemaBook&) { return Json{{"type", "object"}, {"additionalProperties", true}}; };
    return codec;
}

Codec<Json> plain_value() {
    Codec<Json> codec;
    codec.write = [](const Json& value, Writer& out) { out.raw(value.dump()); };
    codec.schema = [](SchemaBook&) { return Json{{"type", {"number", "boolean", "null"}}}; };
    return codec;
}

const Description<VerifiedFigure>& figure_contract() {
    static const auto description = [] {
        using F = VerifiedFigure;
        Description<F> d("VerifiedFigure", "A figure of the result, and the same figure computed a second way.");
        d.field("where", &F::where, words(), "JSON Pointer of the figure in the result.")
            .field("given", &F::given, plain_value(), "The result's value.")
            .field("found", &F::found, plain_value(), "The second way's value; null: it finds none.")
            .field("difference", &F::difference, maybe(only_answered(number())),
                   "Relative difference; left out if a value is no number.")
            .field("allowed", &F::allowed, only_answered(number()), "The largest difference allowed for this figure.")
            .field("agrees", &F::agrees, Codec<bool>{{}, boolean().write, boolean().schema},
                   "False: the difference exceeds what is allowed.");
        return d;
    }();
    return description;
}

const Description<UnverifiedPart>& unverified_contract() {
    static const auto description = [] {
        using U = UnverifiedPart;
        Description<U> d("UnverifiedPart", "A part of the result that has no second way.");
        d.field("where", &U::where, words(), "JSON Pointer of the part.")
            .field("why", &U::why, words(), "The reason, in a sentence.");
        return d;
    }();
    return description;
}

Callable<void(const VerifyAnswer&, Writer&)> written(int (*count)(const VerifyAnswer&)) {
    return [count](const VerifyAnswer& answer, Writer& out) { out.integer(count(answer)); };
}

Json count_schema(SchemaBook&) { return {{"type", "integer"}, {"minimum", 0}}; }

}  // namespace

int VerifyAnswer::differing() const {
    return static_cast<int>(std::ranges::count(figures, false, &VerifiedFigure::agrees));
}

const Description<VerifyRequest>& verify_request_contract() {
    static const auto description = [] {
        using R = VerifyRequest;
        Description<R> d("VerifyRequest", "A result with the request that led to it, or a whole job.");
        d.field("request", &R::request, any_object(), "The request, as sent.", {.required = true})
            .field("result", &R::result, any_object(), "The result, or the answer of a synchronous call.",
                   {.required = true});
        return d;
    }();
    return description;
}

const Description<VerifyAnswer>& verify_answer_contract() {
    static const auto description = [] {
        using A = VerifyAnswer;
        Description<A> d("VerifyAnswer", "Every figure of a result that could be computed a second way.");
        d.field(
             "agrees", {}, [](const A& a, Writer& out) { out.boolean(a.differing() == 0); }, boolean().schema,
             "True if every compared figure agrees.")
            .field("compared", {}, written([](const A& a) { return static_cast<int>(a.figures.size()); }), count_schema,
                   "Figures that were compared.")
            .field("differing", {}, written([](const A& a) { return a.differing(); }), count_schema,
                   "Those that do not agree.")
            .field("figures", &A::figures, list_of(answer(figure_contract())), "Figure by figure.")
            .field("not_verified", &A::not_verified, list_of(answer(unverified_contract())),
                   "Parts without a second way.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
