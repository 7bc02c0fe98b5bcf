#include "api/contract/check/check_result.h"

#include "api/contract/check/loop_check.h"

namespace tunewright::api {
namespace {

using namespace check;

/// Loops are named by their place in `loops`, from 0.
Codec<std::size_t> place() {
    return {{},
            [](const std::size_t& at, Writer& out) { out.integer(static_cast<long long>(at)); },
            integer(0, 1 << 20).schema};
}

const Description<Cluster>& cluster_contract() {
    static const auto description = [] {
        Description<Cluster> d("LoopCluster", "Loops that oscillate together.");
        d.field("period", &Cluster::period, only_answered(number()), "Their period, in seconds.", {.unit = "s"})
            .field("loops", &Cluster::loops, only_answered(list_of(place())),
                   "Places in loops, the likely source first.")
            .field("source", &Cluster::source, only_answered(maybe(place())),
                   "The loop in which it begins; left out if none stands out.")
            .field("detail", &Cluster::why, words(), "A sentence: why this one, or why none.");
        return d;
    }();
    return description;
}

const Description<CascadePair>& cascade_contract() {
    static const auto description = [] {
        Description<CascadePair> d("LoopCascade", "The output of one loop is the set point of another.");
        d.field("master", &CascadePair::master, place(), "The outer loop.")
            .field("slave", &CascadePair::slave, place(), "The inner loop.");
        return d;
    }();
    return description;
}

const Description<Rank>& rank_contract() {
    static const auto description = [] {
        Description<Rank> d("LoopRank", "A loop's place in the work list.");
        d.field("loop", &Rank::loop, place(), "Its place in loops.")
            .field("gain", &Rank::gain, figure(), "By how much mending may lower the mean magnitude of the error.",
                   {.unit = "y"})
            .field("share", &Rank::share, figure(), "The same as a share of the error, 0 to 1.")
            .field("money", &Rank::money, figure(), "The same in money an hour, by the loop's weight.")
            .field("effort", &Rank::effort, only_answered(integer(0, 3)),
                   "0: nothing; 1: settings; 2: a test or a record; 3: work on the plant.")
            .field("after", &Rank::after, only_answered(maybe(place())), "A loop to mend first: it disturbs this one.")
            .why_null("It cannot be told from the record.");
        return d;
    }();
    return description;
}

template <class Owner>
void add_findings(Description<Owner>& d, const CheckResult& (*check)(const Owner&)) {
    const auto part = [&](const char* name, auto codec, auto get, const char* sentence) {
        d.field(
            name, {}, [=](const Owner& owner, Writer& out) { codec.write(get(check(owner)), out); }, codec.schema,
            sentence);
    };
    part(
        "loops", list_of(answer(loop_check_contract())), [](const CheckResult& c) -> const auto& { return c.loops; },
        "The loops, in the order of the request.");
    part(
        "clusters", list_of(answer(cluster_contract())),
        [](const CheckResult& c) -> const auto& { return c.plant.clusters; },
        "Loops that oscillate together, the largest group first.");
    part(
        "cascades", list_of(answer(cascade_contract())),
        [](const CheckResult& c) -> const auto& { return c.plant.cascades; },
        "Pairs of loops of which one gives the other its set point.");
    part(
        "ranking", list_of(answer(rank_contract())),
        [](const CheckResult& c) -> const auto& { return c.plant.ranking; },
        "The work list: every loop once, first the one to mend first.");
    part(
        "partial", boolean(), [](const CheckResult& c) -> const bool& { return c.partial; },
        "True: stopped before all loops were checked.");
}

}  // namespace

const Description<CheckAnswer>& check_result_contract() {
    static const auto description = [] {
        Description<CheckAnswer> d("CheckResult", "The result of a check.");
        add_findings<CheckAnswer>(d, [](const CheckAnswer& a) -> const CheckResult& { return a.check; });
        d.field("units", &CheckAnswer::units, only_answered(maybe(object(units_contract()))), "As in the request.")
            .field(
                "version", {}, [](const CheckAnswer&, Writer& out) { out.text(TUNEWRIGHT_VERSION); }, words().schema,
                "Version of the service.")
            .field("request_hash", &CheckAnswer::request_hash, words(),
                   "SHA-256 of the request in its canonical form.");
        return d;
    }();
    return description;
}

const Description<CheckResult>& check_answer_contract() {
    static const auto description = [] {
        Description<CheckResult> d("CheckCallAnswer", "The answer of a check.");
        add_findings<CheckResult>(d, [](const CheckResult& c) -> const CheckResult& { return c; });
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
