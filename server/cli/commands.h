// The commands that need no service of their own: they answer one question, from files and words.
#pragma once

#include <string>

#include "api/code/code.h"
#include "api/shorthand.h"
#include "server/cli/output.h"

namespace tunewright::server {

// Each returns the exit code of the process: 0 for an answer on standard output; 1 for a problem on standard error.

/// `tunewright tune`, and `tunewright compare` where `all`.
struct TuneCommand {
    std::string file;  ///< a request, a recorded test, "-": standard input; "": the words have a plant
    api::TuneWords words;
    bool all = false;           ///< every method that applies, whatever the file names
    bool plot = false;          ///< the table, and the responses drawn below it
    std::string svg;            ///< file that the responses are drawn into; "": none
    bool with_request = false;  ///< the answer is {request, result}, not the result alone
    OutputWords output;
};
int tune(const TuneCommand& command);

struct RangeCommand {
    std::string file;  ///< a request about a range, as POST /v1/jobs takes it; "-": standard input
    OutputWords output;
};
int range(const RangeCommand& command);

struct IdentifyCommand {
    std::string file;  ///< CSV or a log as it is, or a request of POST /v1/identify; "-": standard input
    api::CsvRequest question;
    OutputWords output;
};
/// The only limit on the file's size is that of a record, 2,000,000 samples.
int identify(const IdentifyCommand& command);

struct PlantCommand {
    std::string text;  ///< "-": standard input
    std::string time_unit = "s";
    OutputWords output;
};
/// What POST /v1/plants/parse answers.
int plant(const PlantCommand& command);

/// A controller of a result that is in a file.
struct ResultWords {
    std::string file;        ///< a result or a job; "-": standard input
    std::string request;     ///< file of the request that it answers; "": not known
    std::string controller;  ///< its number in the result; "": the best
};

struct CodeCommand {
    ResultWords result;
    api::CodeWords words;  ///< parameters of GET /v1/jobs/{id}/controllers/{index}/code
};
int code(const CodeCommand& command);

/// What GET /v1/jobs/{id}/report.html answers.
int report(const ResultWords& command);

/// Lists of what there is; one of them where `name` is given.
struct ListCommand {
    std::string name;
    OutputWords output;
};
int methods(const ListCommand& command);
int controllers(const ListCommand& command);
/// The requests of GET /v1/examples; the one with that id or number, from 1, as a file for `tunewright tune`.
int examples(const ListCommand& command);

/// GET `url` (http://HOST:PORT/PATH, HOST an address or a name), answered within three seconds. Returns 0 where the
/// status is 200; else 1, and standard error says why. 2 where the url cannot be used.
int check_health(const std::string& url);

/// http://HOST:PORT/healthz for what --listen says; loopback where it says every address.
std::string health_url(const std::string& listen);

}  // namespace tunewright::server
