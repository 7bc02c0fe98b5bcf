#include "api/contract/score/score_call.h"

#include "api/certificate/write_certificate.h"
#include "api/contract/controller.h"
#include "api/contract/methods.h"
#include "api/describe/answers.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kLongestName = 200, kMostSettings = 5000;

Codec<CertifiedStructure> structure_choice() {
    Words<CertifiedStructure> words;
    for (const auto one : {CertifiedStructure::pi, CertifiedStructure::pid_tied, CertifiedStructure::pid_fixed})
        words.emplace_back(to_string(one), one);
    return choice<CertifiedStructure>(words);
}

const Description<SubmittedSettings>& settings_contract() {
    static const auto description = [] {
        using S = SubmittedSettings;
        Description<S> d("SubmittedSettings", "Settings for one problem; the filter is the problem's own.");
        d.field("problem", &S::problem, text(kLongestName), "The name of the problem.", {.required = true})
            .field("Kp", &S::Kp, number(), "Gain.", {.required = true})
            .field("Ti", &S::Ti, number({.exclusive_minimum = 0}), "Integral time.", {.required = true})
            .field("Td", &S::Td, number({.minimum = 0}), "Derivative time.");
        return d;
    }();
    return description;
}

const Description<ProblemChoice>& choice_contract() {
    static const auto description = [] {
        using C = ProblemChoice;
        Description<C> d("ProblemChoice", "The problems that count.");
        d.field("name", &C::name, maybe(text(kLongestName)), "The beginning of their names, such as amigo/.")
            .field("structure", &C::structure, maybe(structure_choice()),
                   "pi, pid_tied (Tf = Td/10) or pid_fixed (Tf is given). Default: all that the rule can design.")
            .field("Ms", &C::Ms, maybe(number({.exclusive_minimum = 1})), "Their limit on Ms.");
        return d;
    }();
    return description;
}

Codec<double> plain() { return number(); }

const Description<score::ProblemScore>& problem_score_contract() {
    static const auto description = [] {
        using P = score::ProblemScore;
        const auto judged = [](const P& p) {
            return p.status == score::Status::kept || p.status == score::Status::limits_broken;
        };
        const auto if_judged = [judged](const P& p) { return !judged(p); };
        const SchemaOf schema = plain().schema;
        const auto figure = [](double P::*member) {
            return [member](const P& p, Writer& out) { out.number(p.*member); };
        };
        Description<P> d("ProblemScore", "A rule on one problem.");
        d.field("name", &P::name, text(kLongestName), "The problem.")
            .field(
                "status", {}, [](const P& p, Writer& out) { out.text(score::to_string(p.status)); },
                [](SchemaBook&) {
                    return Json{{"type", "string"}, {"enum", {"kept", "limits-broken", "unstable", "no-settings"}}};
                },
                "kept: both limits hold.")
            .field("tau", &P::tau, plain(), "L/(L + T) of the plant's first-order reduction.")
            .field(
                "controller", {}, [](const P& p, Writer& out) { controller_contract().write(p.controller, out); },
                [](SchemaBook& book) { return controller_contract().schema(book); },
                "The settings, with the problem's filter.", {},
                [](const P& p) { return p.status == score::Status::no_settings; })
            .field("Ms", {}, figure(&P::Ms), schema, "", {}, if_judged)
            .field("Mt", {}, figure(&P::Mt), schema, "", {}, if_judged)
            .field("IAE", {}, figure(&P::IAE), schema, "After a unit load step.", {}, if_judged)
            .field("ratio", {}, figure(&P::ratio), schema,
                   "IAE over the proved bound; with broken limits it may be below 1.", {}, if_judged)
            .field(
                "why", {}, [](const P& p, Writer& out) { out.text(p.why); }, text(1000).schema,
                "Why there are no settings.", {}, [](const P& p) { return p.why.empty(); });
        return d;
    }();
    return description;
}

const Description<score::Range>& range_contract() {
    static const auto description = [] {
        using R = score::Range;
        Description<R> d("ScoreRange", "The longest run of problems, by tau, on which the rule keeps all limits.");
        d.field("tau_low", &R::tau_low, plain(), "Where it begins.")
            .field("tau_high", &R::tau_high, plain(), "Where it ends.")
            .field("problems", &R::problems, integer({.minimum = 0}), "Problems in it.")
            .field("worst_ratio", &R::worst_ratio, plain(), "The largest ratio in it.");
        return d;
    }();
    return description;
}

const Description<score::ProfilePoint>& profile_contract() {
    static const auto description = [] {
        using P = score::ProfilePoint;
        Description<P> d("ProfilePoint", "A step of the performance profile (Dolan and Moré 2002).");
        d.field("ratio", &P::ratio, plain(), "IAE over the proved bound.")
            .field("share", &P::share, plain(), "The share of all problems that are solved within this ratio.");
        return d;
    }();
    return description;
}

/// A member of the answer's score.
template <class M>
Callable<void(const ScoreAnswer&, Writer&)> of_score(M score::Score::*member, const Codec<M>& codec) {
    return [member, write = codec.write](const ScoreAnswer& a, Writer& out) { write(a.score.*member, out); };
}

void check_score(const Json&, ScoreRequest& request, Reader& reader) {
    if (request.tune.has_value() == !request.settings.empty())
        reader.fault_at("tune", "Give either tune, a method such as formula, or settings, the settings of problems.");
    if (request.tune && request.tune->of_all())
        reader.fault_at("tune", "A score is about one method; name it, such as simc.");
}

}  // namespace

bool ProblemChoice::admits(const score::Problem& problem) const {
    return (!name || problem.name.starts_with(*name)) && (!structure || problem.structure == *structure) &&
           (!Ms || problem.Ms == *Ms);
}

const Description<ScoreRequest>& score_request_contract() {
    static const auto description = [] {
        using R = ScoreRequest;
        Description<R> d("ScoreRequest",
                         "A tuning rule, or the settings of one, against the library of problems with proved bounds.");
        d.field("name", &R::name, maybe(text(kLongestName)), "A name for the answer.")
            .field("tune", &R::tune, maybe(method_request()),
                   "The rule: a method with its options; the method formula takes formulas of your own. Ms, Mt and "
                   "controller follow each problem unless they are given.")
            .field("settings", &R::settings, list_of(object(settings_contract()), 1, kMostSettings),
                   "In place of a rule: settings for problems by name.")
            .field("problems", &R::problems, object(choice_contract()), "The problems that count.")
            .check(check_score)
            .example({{"tune", {{"method", "formula"}, {"Kp", "T/(2*K*L)"}, {"Ti", "min(T, 8*L)"}}},
                      {"problems", {{"Ms", 1.6}}}});
        return d;
    }();
    return description;
}

const Description<ScoreAnswer>& score_answer_contract() {
    static const auto description = [] {
        using A = ScoreAnswer;
        using S = score::Score;
        const auto problems = list_of(answer(problem_score_contract()));
        const auto profile = list_of(answer(profile_contract()));
        const auto range = maybe(answer(range_contract()));
        const auto count = integer({.minimum = 0});
        const auto ratio = maybe(plain());
        Description<A> d("ScoreAnswer", "How near a rule comes to the best possible.");
        d.field("name", &A::name, text(kLongestName), "The rule.")
            .field("kept", {}, of_score(&S::kept, count), count.schema, "Problems whose limits hold.")
            .field("limits_broken", {}, of_score(&S::limits_broken, count), count.schema,
                   "Problems with Ms or Mt above the limit.")
            .field("unstable", {}, of_score(&S::unstable, count), count.schema, "Problems without stability.")
            .field("no_settings", {}, of_score(&S::no_settings, count), count.schema,
                   "Problems for which the rule has no settings.")
            .field("median_ratio", {}, of_score(&S::median_ratio, ratio), ratio.schema,
                   "IAE over the proved bound, of the problems whose limits hold.", {},
                   [](const A& a) { return !a.score.median_ratio; })
            .field("worst_ratio", {}, of_score(&S::worst_ratio, ratio), ratio.schema, "The largest of them.", {},
                   [](const A& a) { return !a.score.worst_ratio; })
            .field("range", {}, of_score(&S::range, range), range.schema, "Where the rule can be used.", {},
                   [](const A& a) { return !a.score.range; })
            .field("profile", {}, of_score(&S::profile, profile), profile.schema, "The performance profile.")
            .field("problems", {}, of_score(&S::problems, problems), problems.schema, "Problem by problem.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
