// Commands that need no running service: each answers one question from files and arguments.
#pragma once

#include <string>

#include "api/code/code.h"
#include "api/services/score_service.h"
#include "api/shorthand.h"
#include "server/cli/output.h"

namespace tunewright::server {

// Each function returns the exit code of the process: 0 for an answer on standard output; 1 for a problem on standard
// error.

/// `tunewright tune`, and with `all` `tunewright compare`.
struct TuneCommand {
    std::string file;  ///< a request, a recorded test, "-": standard input; "": the arguments have a plant
    api::TuneWords words;
    bool all = false;           ///< every method that applies, whatever the file asks for
    bool plot = false;          ///< the table, with the responses drawn below it
    std::string svg;            ///< file for the drawing of the responses; "": none
    bool with_request = false;  ///< the answer is {request, result} instead of the result alone
    OutputWords output;
};
int tune(const TuneCommand& command);

/// `tunewright range`, and with `structure` `tunewright cascade` and its like.
struct RequestCommand {
    std::string file;       ///< a request as POST /v1/jobs takes it; "-": standard input
    std::string structure;  ///< "": about a range
    OutputWords output;
};
int answer_request(const RequestCommand& command);

struct IdentifyCommand {
    std::string file;  ///< a CSV file or a log, or a request of POST /v1/identify; "-": standard input
    api::CsvRequest question;
    OutputWords output;
};
/// The file's size is limited only by the length of a record, 2,000,000 samples.
int identify(const IdentifyCommand& command);

struct ControllerRecordCommand {
    std::string file;  ///< a CSV file or a log, or a request of POST /v1/records/controller; "-": standard input
    api::CsvRequest question;
    OutputWords output;
};
int controller_record(const ControllerRecordCommand& command);

struct ScoreCommand {
    std::string file;  ///< a request, or a CSV of settings; "": the words; "-": standard input
    api::ScoreWords words;
    OutputWords output;
};
int score(const ScoreCommand& command);

struct PlantCommand {
    std::string text;  ///< "-": standard input
    std::string time_unit = "s";
    OutputWords output;
};
/// The answer of POST /v1/plants/parse.
int plant(const PlantCommand& command);

/// A controller of a result in a file.
struct ResultWords {
    std::string file;        ///< a result or a job; "-": standard input
    std::string request;     ///< file of the request that led to it; "": not known
    std::string controller;  ///< its number in the result; "": the best one
};

struct CodeCommand {
    ResultWords result;
    api::CodeWords words;     ///< parameters of GET /v1/jobs/{id}/controllers/{index}/code
    bool experiment = false;  ///< the words are members of the request of POST /v1/experiments/code; there is no result
};
int code(const CodeCommand& command);

/// The answer of GET /v1/jobs/{id}/controllers/{index}/certificate.
int certificate(const ResultWords& command);

struct VerifyCommand {
    ResultWords result;  ///< every controller is verified
    OutputWords output;
};
/// The answer of POST /v1/verify; returns 1 also if a figure differs.
int verify(const VerifyCommand& command);

/// The answer of GET /v1/jobs/{id}/report.html.
int report(const ResultWords& command);

/// Lists; a single item if `name` is given.
struct ListCommand {
    std::string name;
    OutputWords output;
};
int methods(const ListCommand& command);
int controllers(const ListCommand& command);
/// The requests of GET /v1/examples; a single one by id or number, from 1, as a file for `tunewright tune`.
int examples(const ListCommand& command);

/// GET `url` (http://HOST:PORT/PATH, HOST an address or a name), with a limit of three seconds. Returns 0 for the
/// status 200; otherwise 1, with the reason on standard error. 2 if the URL cannot be used.
int check_health(const std::string& url);

/// http://HOST:PORT/healthz for the address of --listen; loopback if that is every address.
std::string health_url(const std::string& listen);

}  // namespace tunewright::server
