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
        "Pairs of loops: the output of one is the set point of the other.");
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
            .field("request_hash", &CheckAnswer::request_hash, words(), "SHA-256 of the request in its canonical form.")
            .field("notes", &CheckAnswer::notes,
                   unless<std::vector<std::string>>(list_of(words()), [](const auto& notes) { return notes.empty(); }),
                   "Findings about the files of a check on the command line, such as tags that are not checked.");
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

namespace {

const Description<Change>& change_contract() {
    static const auto description = [] {
        Description<Change> d("LoopChange", "What has changed since an earlier check.");
        d.field("before", &Change::before, only_answered(check_verdict()), "The earlier cause.")
            .field("now", &Change::now, only_answered(check_verdict()), "The cause now.")
            .field("variability_ratio", &Change::variability_ratio, figure(),
                   "Standard deviation of the error, now over before.")
            .field("likelihood", &Change::likelihood, figure(),
                   "Of so large a change by chance, 0 to 1 (F test with the independent values of each record).")
            .field("significant", &Change::significant, only_answered(boolean()), "True: chance does not explain it.")
            .why_null("The two records cannot be compared.");
        return d;
    }();
    return description;
}

void write_texts(const std::vector<std::string>& texts, Writer& out) {
    out.begin_array();
    for (const std::string& text : texts) out.raw(text);
    out.end_array();
}

void write_changes(const BatchCheck& check, Writer& out) {
    out.begin_array();
    for (std::size_t i = 0; i < check.changes.size(); ++i) {
        out.begin_object();
        out.key("loop").integer(static_cast<long long>(check.compared[i].loop));
        out.key("tag").text(check.compared[i].tag);
        out.key("change");
        change_contract().write(check.changes[i], out);
        out.end_object();
    }
    out.end_array();
}

Json changes_schema(SchemaBook& book) {
    return {{"type", "array"},
            {"items",
             {{"type", "object"},
              {"properties",
               {{"loop", {{"type", "integer"}}},
                {"tag", {{"type", "string"}}},
                {"change", change_contract().schema(book)}}},
              {"required", {"loop", "tag", "change"}}}}};
}

}  // namespace

namespace {

Codec<std::vector<std::string>> tags() { return list_of(words()); }

}  // namespace

const Description<BatchCheck>& batch_check_contract() {
    static const auto description = [] {
        using B = BatchCheck;
        Description<B> d("BatchCheck", "What the loops of a batch of checks say together, as far as they are checked.");
        d.field(
             "loops", {}, [](const B& check, Writer& out) { write_texts(check.loops, out); },
             list_of(answer(loop_of_batch_contract())).schema,
             "The loops, with index and job of each, without the parts that only its own result has (excerpt, "
             "spectrum, "
             "autocorrelation, shape). The cause of a loop that its neighbour disturbs is external here.")
            .field(
                "clusters", {},
                [](const B& check, Writer& out) {
                    list_of(answer(cluster_contract())).write(check.plant.clusters, out);
                },
                list_of(answer(cluster_contract())).schema, "Loops that oscillate together, the largest group first.")
            .field(
                "cascades", {},
                [](const B& check, Writer& out) {
                    list_of(answer(cascade_contract())).write(check.plant.cascades, out);
                },
                list_of(answer(cascade_contract())).schema,
                "Pairs of loops: the output of one is the set point of the other.")
            .field(
                "ranking", {},
                [](const B& check, Writer& out) { list_of(answer(rank_contract())).write(check.plant.ranking, out); },
                list_of(answer(rank_contract())).schema, "The work list, first the loop to mend first.")
            .field("changes", {}, write_changes, changes_schema,
                   "With before: what has changed in each loop since that batch, by tag.", {},
                   [](const B& check) { return check.compared.empty(); })
            .field(
                "only_now", {}, [](const B& check, Writer& out) { tags().write(check.only_now, out); }, tags().schema,
                "With before: tags that the earlier batch has not.", {},
                [](const B& check) { return check.only_now.empty(); })
            .field(
                "only_before", {}, [](const B& check, Writer& out) { tags().write(check.only_before, out); },
                tags().schema, "With before: tags that only the earlier batch has.", {},
                [](const B& check) { return check.only_before.empty(); })
            .field("failed", &B::failed, only_answered(integer(0, 1 << 30)), "Entries without an answer.")
            .field("complete", &B::complete, only_answered(boolean()),
                   "True: the batch has ended, and none of it was cancelled.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
