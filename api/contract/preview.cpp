#include "api/contract/preview.h"

#include "api/contract/record.h"

namespace tunewright::api {
namespace {

Codec<int> count() { return only_answered(integer(0, std::numeric_limits<int>::max())); }
Codec<double> value() { return only_answered(number()); }

const Description<CsvSkip>& skip_contract() {
    static const auto description = [] {
        Description<CsvSkip> d("SkippedLine", "A line of the file that is not a row.");
        d.field("line", &CsvSkip::line, count(), "Its number, from 1.")
            .field("reason", &CsvSkip::reason, words(), "Reason.");
        return d;
    }();
    return description;
}

const Description<CsvFault>& reading_problem_contract() {
    static const auto description = [] {
        Description<CsvFault> d("ReadingProblem", "Reason why the record cannot be read yet.");
        d.field("pointer", &CsvFault::where, words(), "Member of a record that corrects it: columns/t, csv.")
            .field("detail", &CsvFault::message, words(), "The sentence.");
        return d;
    }();
    return description;
}

const Description<PreviewColumn>& preview_column_contract() {
    static const auto description = [] {
        using C = PreviewColumn;
        Description<C> d("PreviewColumn", "A column of the file.");
        d.field("heading", &C::heading, words(), "As in the file; empty if it has none.")
            .field("guess", &C::guess, words(), "Role of the column in the record: t, u, y, r, mode, or - for none.")
            .field("confidence", &C::confidence, value(),
                   "1: chosen, or an exact name; 0.9: a tag that ends in one; 0.7: a name that contains one; 0.5: from "
                   "the contents.")
            .field("unit", &C::unit, words(), "As in the file; empty if it has none.")
            .field("first", &C::first, words(), "The first cell that is not blank, as written.")
            .field("min", &C::min, only_answered(maybe(number())), "Smallest number; missing if there is none.")
            .field("max", &C::max, only_answered(maybe(number())), "Largest number.")
            .field("thumbnail", &C::thumbnail, trace(),
                   "At most 240 numbers: all of them, or minimum and maximum of equal stretches, in turn.");
        return d;
    }();
    return description;
}

const Description<CsvRun>& preview_run_contract() {
    static const auto description = [] {
        Description<CsvRun> d("PreviewRun", "A run of a file that contains several; each begins a new time axis.");
        d.field("first_line", &CsvRun::first_line, count(), "Its first line in the file, from 1.")
            .field("last_line", &CsvRun::last_line, count(), "Its last line.")
            .field("rows", &CsvRun::rows, count(), "Its rows.")
            .field("from", &CsvRun::from, value(), "Smallest time, in the file's unit.", {.unit = "time"})
            .field("to", &CsvRun::to, value(), "Largest time.", {.unit = "time"})
            .field("tests", &CsvRun::tests, only_answered(boolean()), "u moves in it and y responds.");
        return d;
    }();
    return description;
}

const Description<PreviewTime>& preview_time_contract() {
    static const auto description = [] {
        using T = PreviewTime;
        Description<T> d("PreviewTime", "The times of the rows.");
        d.field("unit", &T::unit, words(), "Unit of these times.")
            .field("assumed", &T::assumed, only_answered(boolean()), "The file does not state the unit: it is assumed.")
            .field("from", &T::from, value(), "First.", {.unit = "time"})
            .field("to", &T::to, value(), "Last.", {.unit = "time"})
            .field("dt", &T::dt, value(), "Usual spacing.", {.unit = "time"})
            .field("gaps", &T::gaps, count(), "Number of spacings of more than five times dt.")
            .field("duplicates", &T::duplicates, count(), "Rows with the time of the row above.");
        return d;
    }();
    return description;
}

void check_preview(const Json&, PreviewRequest& request, Reader& reader) {
    if (!request.csv) reader.fault_at("csv", "csv is missing; it is the text of the file.");
}

}  // namespace

const Description<PreviewRequest>& preview_request_contract() {
    static const auto description = [] {
        using R = PreviewRequest;
        Description<R> d("PreviewRequest", "A file of a recorded test, and the choices for reading it.");
        d.field("csv", &R::csv, maybe(text(kMaxCsvLength)), "The text of the file.", {.required = true})
            .field("columns", &R::columns, maybe(object(columns_contract())), "Columns, if they are chosen.")
            .field("dt", &R::dt, maybe(number({.exclusive_minimum = 0})), "Sampling time of a file without times.")
            .field("time_unit", &R::time_unit, maybe(file_time_unit()),
                   "Unit of the file's times, if it states none or a wrong one.")
            .field("u_step", &R::u_step, maybe(u_step()), "For a file without u: the step of u at the first row.")
            .field("run", &R::run, maybe(run_number()), "For a file with several runs: the one that is read, from 1.")
            .check(check_preview)
            .example({{"csv", "t,u,y\n0,0,20\n1,5,20\n2,5,21\n"}});
        return d;
    }();
    return description;
}

const Description<CsvPreview>& preview_answer_contract() {
    static const auto description = [] {
        using P = CsvPreview;
        Description<P> d("PreviewAnswer", "The interpretation of the file.");
        d.field("columns", &P::columns, list_of(answer(preview_column_contract())), "In the order of the file.")
            .field("rows", &P::rows, count(), "Lines of data.")
            .field("separator", &P::separator, words(),
                   "The separating sign, tab or blanks; pairs: each line names its values; values: each value has its "
                   "own line, or the file is JSON.")
            .field("decimal", &P::decimal, words(), "Decimal sign of the numbers.")
            .field("encoding", &P::encoding, words(),
                   "utf-8, utf-16le, utf-16be, windows-1252 or iso-8859-1; for JSON always utf-8.")
            .field("time", &P::time, maybe(answer(preview_time_contract())), "Missing if the record cannot be read.")
            .field("runs", &P::runs, list_of(answer(preview_run_contract())),
                   "The runs, if the times start again; empty: one run.")
            .field("run", &P::run, maybe(count()), "For several runs: the one that is read, from 1.")
            .field("skipped", &P::skipped, list_of(answer(skip_contract())), "Lines that are not rows, the first 100.")
            .field("skipped_lines", &P::skipped_lines, count(), "Number of lines of data that are skipped.")
            .field("notes", &P::notes, list_of(words()), "Automatic decisions, one sentence each.")
            .field("problems", &P::problems, list_of(answer(reading_problem_contract())),
                   "Reasons why the record cannot be read; empty: it can be identified.");
        return d;
    }();
    return description;
}

CsvOptions csv_options(const PreviewRequest& request) {
    CsvOptions options;
    options.columns = request.columns.value_or(ColumnChoices{});
    options.file_time_unit = request.time_unit.value_or("");
    options.dt = request.dt;
    options.u_step = request.u_step;
    options.run = request.run;
    options.max_samples = kMaxSamples;
    return options;
}

}  // namespace tunewright::api
