// The tables of the PostgreSQL store and the steps that lead to them.
#include "server/store/postgres/schema.h"

#include <array>

namespace tunewright::server::postgres {
namespace {

// The number is the service's own in the database: "tunewrig" in ASCII.
constexpr const char* kLock = "SELECT pg_advisory_xact_lock(x'74756e6577726967'::bigint)";

// The rules of the states are also in the database. Batches count their entries by a trigger; each connection counts in
// a row of its own, so that replicas which finish entries of one batch do not wait for each other. jobs.batch is not a
// foreign key, because its check would be one more look-up per entry: only a batch without entries is deleted.
constexpr const char* kStep1 = R"sql(
CREATE TABLE batches (
    seq bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    id text COLLATE "C" NOT NULL UNIQUE CHECK (length(id) > 0),
    name text NOT NULL,
    owner text NOT NULL,
    flow text NOT NULL,
    created_at bigint NOT NULL,
    heard_at timestamptz NOT NULL DEFAULT clock_timestamp(),
    state text NOT NULL DEFAULT 'receiving' CHECK (state IN ('receiving', 'sealed', 'leaving')),
    cancel_requested boolean NOT NULL DEFAULT false,
    request_hash text NOT NULL DEFAULT '',
    idempotency_key text COLLATE "C",
    UNIQUE (owner, idempotency_key)
);
CREATE INDEX batches_unsettled ON batches (state) WHERE state <> 'sealed' OR cancel_requested;
CREATE TABLE batch_counts (
    batch bigint NOT NULL REFERENCES batches (seq) ON DELETE CASCADE,
    slot integer NOT NULL,
    queued bigint NOT NULL,
    running bigint NOT NULL,
    succeeded bigint NOT NULL,
    failed bigint NOT NULL,
    cancelled bigint NOT NULL,
    last_end bigint NOT NULL,
    PRIMARY KEY (batch, slot)
) WITH (fillfactor = 50);

CREATE TABLE jobs (
    seq bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    id text COLLATE "C" NOT NULL UNIQUE CHECK (length(id) > 0),
    name text COLLATE "C" NOT NULL,
    status text COLLATE "C" NOT NULL CHECK (status IN ('queued', 'running', 'succeeded', 'failed', 'cancelled')),
    class smallint NOT NULL,
    turn bigint NOT NULL,
    owner text COLLATE "C" NOT NULL,
    flow text COLLATE "C" NOT NULL,
    batch bigint,
    batch_index bigint CHECK (batch_index >= 0),
    created_at bigint NOT NULL,
    started_at bigint,
    finished_at bigint,
    attempts integer NOT NULL DEFAULT 0 CHECK (attempts >= 0),
    worker text,
    lease_until timestamptz,
    timeout_s double precision NOT NULL CHECK (timeout_s > 0),
    request_hash text NOT NULL,
    cancel_requested boolean NOT NULL DEFAULT false,
    version text,
    idempotency_key text COLLATE "C",
    request text,
    result text,
    error text,
    progress text,
    progress_attempts integer,
    CHECK ((finished_at IS NOT NULL) = (status IN ('succeeded', 'failed', 'cancelled'))),
    CHECK (status <> 'running' OR (started_at IS NOT NULL AND attempts > 0)),
    CHECK ((worker IS NOT NULL) = (status = 'running') AND (lease_until IS NOT NULL) = (status = 'running')),
    CHECK (status <> 'succeeded' OR attempts > 0),
    CHECK (class = CASE WHEN batch IS NULL THEN 0 ELSE 1 END AND (batch IS NULL) = (batch_index IS NULL))
) WITH (autovacuum_vacuum_scale_factor = 0.05, autovacuum_analyze_scale_factor = 0.05);
CREATE UNIQUE INDEX jobs_by_key ON jobs (owner, idempotency_key) WHERE idempotency_key IS NOT NULL;
CREATE INDEX jobs_waiting ON jobs (class, turn, seq) WHERE status = 'queued';
CREATE INDEX jobs_flows ON jobs (class, flow, turn) WHERE status = 'queued';
CREATE INDEX jobs_running ON jobs (class, turn) WHERE status = 'running';
CREATE INDEX jobs_single ON jobs (seq) WHERE class = 0;
CREATE INDEX jobs_by_status ON jobs (status, seq) WHERE class = 0;
CREATE INDEX jobs_by_name ON jobs (name, seq) WHERE class = 0;
CREATE INDEX jobs_by_owner ON jobs (owner, seq) WHERE class = 0;
CREATE INDEX jobs_by_end ON jobs (finished_at) WHERE class = 0 AND finished_at IS NOT NULL;
CREATE UNIQUE INDEX jobs_by_batch ON jobs (batch, batch_index) WHERE batch IS NOT NULL;

CREATE FUNCTION refuse_move() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN
    RAISE EXCEPTION 'job % cannot move from % (attempts %) to % (attempts %)',
        OLD.id, OLD.status, OLD.attempts, NEW.status, NEW.attempts USING ERRCODE = 'check_violation';
END $$;
CREATE TRIGGER jobs_move BEFORE UPDATE ON jobs FOR EACH ROW
    WHEN ((OLD.status <> NEW.status AND OLD.status IN ('succeeded', 'failed', 'cancelled'))
       OR (OLD.status = 'queued' AND NEW.status IN ('succeeded', 'failed'))
       OR NEW.attempts <> OLD.attempts
                          + CASE WHEN OLD.status = 'queued' AND NEW.status = 'running' THEN 1 ELSE 0 END)
    EXECUTE FUNCTION refuse_move();

CREATE FUNCTION count_entries_added() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN
    INSERT INTO batch_counts AS c (batch, slot, queued, running, succeeded, failed, cancelled, last_end)
        SELECT n.batch, pg_backend_pid() % 64, count(*) FILTER (WHERE n.status = 'queued'),
               count(*) FILTER (WHERE n.status = 'running'), count(*) FILTER (WHERE n.status = 'succeeded'),
               count(*) FILTER (WHERE n.status = 'failed'), count(*) FILTER (WHERE n.status = 'cancelled'),
               coalesce(max(n.finished_at), 0)
        FROM new_rows n WHERE n.batch IS NOT NULL GROUP BY n.batch ORDER BY n.batch
        ON CONFLICT (batch, slot) DO UPDATE SET queued = c.queued + EXCLUDED.queued,
            running = c.running + EXCLUDED.running, succeeded = c.succeeded + EXCLUDED.succeeded,
            failed = c.failed + EXCLUDED.failed, cancelled = c.cancelled + EXCLUDED.cancelled,
            last_end = greatest(c.last_end, EXCLUDED.last_end);
    RETURN NULL;
END $$;
CREATE FUNCTION count_entries_moved() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN
    INSERT INTO batch_counts AS c (batch, slot, queued, running, succeeded, failed, cancelled, last_end)
        SELECT n.batch, pg_backend_pid() % 64,
               count(*) FILTER (WHERE n.status = 'queued') - count(*) FILTER (WHERE o.status = 'queued'),
               count(*) FILTER (WHERE n.status = 'running') - count(*) FILTER (WHERE o.status = 'running'),
               count(*) FILTER (WHERE n.status = 'succeeded'), count(*) FILTER (WHERE n.status = 'failed'),
               count(*) FILTER (WHERE n.status = 'cancelled'), coalesce(max(n.finished_at), 0)
        FROM new_rows n JOIN old_rows o ON o.seq = n.seq
        WHERE n.batch IS NOT NULL AND n.status <> o.status GROUP BY n.batch ORDER BY n.batch
        ON CONFLICT (batch, slot) DO UPDATE SET queued = c.queued + EXCLUDED.queued,
            running = c.running + EXCLUDED.running, succeeded = c.succeeded + EXCLUDED.succeeded,
            failed = c.failed + EXCLUDED.failed, cancelled = c.cancelled + EXCLUDED.cancelled,
            last_end = greatest(c.last_end, EXCLUDED.last_end);
    RETURN NULL;
END $$;
CREATE TRIGGER entries_added AFTER INSERT ON jobs REFERENCING NEW TABLE AS new_rows
    FOR EACH STATEMENT EXECUTE FUNCTION count_entries_added();
CREATE TRIGGER entries_moved AFTER UPDATE ON jobs REFERENCING OLD TABLE AS old_rows NEW TABLE AS new_rows
    FOR EACH STATEMENT EXECUTE FUNCTION count_entries_moved();

-- Large texts are pressed by the faster method, where the server was built with it.
DO $$ BEGIN
    ALTER TABLE jobs ALTER COLUMN request SET COMPRESSION lz4;
    ALTER TABLE jobs ALTER COLUMN result SET COMPRESSION lz4;
EXCEPTION WHEN feature_not_supported OR syntax_error THEN NULL;
END $$;
)sql";

// A job that was running when its process ended may be the cause; one for which that happened twice waits a while and
// then runs alone.
constexpr const char* kStep2 = R"sql(
ALTER TABLE jobs ADD COLUMN crashes integer NOT NULL DEFAULT 0 CHECK (crashes >= 0);
ALTER TABLE jobs ADD COLUMN not_before timestamptz;
CREATE INDEX jobs_suspect ON jobs (not_before) WHERE status = 'queued' AND crashes > 1;
)sql";

// The outline of an ended job for lists: small, so that a page of jobs reads no result.
constexpr const char* kStep3 = "ALTER TABLE jobs ADD COLUMN outline text";

// A job is in one of three places: it waits, it runs, or it has ended. Its constant data are in `jobs`, written once;
// `waiting` and `running` are narrow, so that a claim and an end touch no wide row and few indexes. The tables have no
// foreign keys to `jobs`, whose check would cost as much as the change. Processes write their heartbeats to `workers`,
// one row each. `ended_at` of a batch is null while jobs of it wait or run, or its end has not been noticed yet.
// `upkeep` has the time of the last run of tasks that one process does for all.
constexpr const char* kStep4 = R"sql(
DROP TRIGGER jobs_move ON jobs;
DROP TRIGGER entries_added ON jobs;
DROP TRIGGER entries_moved ON jobs;
DROP FUNCTION refuse_move();
DROP FUNCTION count_entries_added();
DROP FUNCTION count_entries_moved();
DROP INDEX jobs_waiting, jobs_flows, jobs_running, jobs_single, jobs_by_status, jobs_by_name, jobs_by_owner,
    jobs_by_end, jobs_suspect, batches_unsettled;

CREATE TABLE waiting (
    class smallint NOT NULL CHECK (class IN (0, 1)),
    turn bigint NOT NULL,
    seq bigint NOT NULL,
    flow text COLLATE "C" NOT NULL,
    batch bigint,
    attempts integer NOT NULL DEFAULT 0 CHECK (attempts >= 0),
    crashes integer NOT NULL DEFAULT 0 CHECK (crashes >= 0 AND crashes <= attempts),
    not_before timestamptz,
    PRIMARY KEY (class, turn, seq)
) WITH (autovacuum_vacuum_scale_factor = 0.02, autovacuum_vacuum_threshold = 2000);
INSERT INTO waiting SELECT class, turn, seq, flow, batch, attempts, least(crashes, attempts), not_before FROM jobs
    WHERE status = 'queued';
CREATE INDEX waiting_flows ON waiting (class, flow, turn);
CREATE INDEX waiting_single ON waiting (seq) WHERE batch IS NULL;
CREATE INDEX waiting_suspects ON waiting (not_before) WHERE crashes > 1;

CREATE TABLE running (
    seq bigint PRIMARY KEY,
    class smallint NOT NULL,
    turn bigint NOT NULL,
    flow text COLLATE "C" NOT NULL,
    batch bigint,
    worker text COLLATE "C" NOT NULL,
    attempts integer NOT NULL CHECK (attempts > 0),
    crashes integer NOT NULL CHECK (crashes >= 0 AND crashes < attempts),
    started_at bigint NOT NULL,
    cancel_requested boolean NOT NULL DEFAULT false,
    progress text
) WITH (fillfactor = 50, autovacuum_vacuum_scale_factor = 0, autovacuum_vacuum_threshold = 1000);
INSERT INTO running SELECT seq, class, turn, flow, batch, worker, attempts, least(crashes, attempts - 1), started_at,
    cancel_requested, NULL FROM jobs WHERE status = 'running';
CREATE INDEX running_workers ON running (worker);

CREATE TABLE ended (
    seq bigint PRIMARY KEY,
    single boolean NOT NULL,
    status text COLLATE "C" NOT NULL CHECK (status IN ('succeeded', 'failed', 'cancelled')),
    attempts integer NOT NULL CHECK (attempts >= 0),
    cancel_requested boolean NOT NULL,
    started_at bigint,
    finished_at bigint NOT NULL,
    version text,
    outline text,
    error text,
    result text,
    CHECK (status <> 'succeeded' OR (attempts > 0 AND started_at IS NOT NULL))
);
DO $$ BEGIN
    ALTER TABLE ended ALTER COLUMN result SET COMPRESSION lz4;
EXCEPTION WHEN feature_not_supported OR syntax_error THEN NULL;
END $$;
INSERT INTO ended SELECT seq, batch IS NULL, status, attempts, cancel_requested, started_at, finished_at, version,
    outline, error, result FROM jobs WHERE finished_at IS NOT NULL;
CREATE INDEX ended_by_status ON ended (status, seq) WHERE single;
CREATE INDEX ended_by_end ON ended (status, finished_at) WHERE single;

ALTER TABLE jobs DROP COLUMN status, DROP COLUMN started_at, DROP COLUMN finished_at, DROP COLUMN attempts,
    DROP COLUMN worker, DROP COLUMN lease_until, DROP COLUMN cancel_requested, DROP COLUMN version, DROP COLUMN result,
    DROP COLUMN error, DROP COLUMN progress, DROP COLUMN progress_attempts, DROP COLUMN crashes,
    DROP COLUMN not_before, DROP COLUMN outline,
    ADD COLUMN notify text, ADD COLUMN request_id text NOT NULL DEFAULT '',
    ADD COLUMN traceparent text NOT NULL DEFAULT '';
DO $$ DECLARE rule text; BEGIN  -- of step 1: that only entries are of the low class
    FOR rule IN SELECT conname FROM pg_constraint WHERE conrelid = 'jobs'::regclass AND contype = 'c'
                AND pg_get_constraintdef(oid) LIKE '%class%' LOOP
        EXECUTE format('ALTER TABLE jobs DROP CONSTRAINT %I', rule);
    END LOOP;
END $$;
ALTER TABLE jobs ADD CHECK (class IN (0, 1)), ADD CHECK ((batch IS NULL) = (batch_index IS NULL));
CREATE INDEX jobs_single ON jobs (seq) WHERE batch IS NULL;
CREATE INDEX jobs_by_name ON jobs (name, seq) WHERE batch IS NULL AND name <> '';
CREATE INDEX jobs_by_owner ON jobs (owner, seq) WHERE batch IS NULL AND owner <> '';
CREATE INDEX jobs_notify ON jobs (seq) WHERE notify IS NOT NULL;

ALTER TABLE batches ADD COLUMN notify text, ADD COLUMN request_id text NOT NULL DEFAULT '',
    ADD COLUMN traceparent text NOT NULL DEFAULT '', ADD COLUMN ended_at bigint;
CREATE INDEX batches_unsettled ON batches (state) WHERE ended_at IS NULL;
CREATE INDEX batches_by_end ON batches (ended_at) WHERE ended_at IS NOT NULL;

CREATE TABLE workers (name text COLLATE "C" PRIMARY KEY, lease_until timestamptz NOT NULL) WITH (fillfactor = 50);
CREATE TABLE settings (name text PRIMARY KEY, value text NOT NULL);
CREATE TABLE upkeep (task text PRIMARY KEY, done_at timestamptz NOT NULL) WITH (fillfactor = 50);
INSERT INTO upkeep VALUES ('reclaim', '-infinity');
CREATE TABLE deliveries (
    seq bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    target text NOT NULL,
    job text NOT NULL DEFAULT '',
    batch text NOT NULL DEFAULT '',
    tries integer NOT NULL DEFAULT 0,
    created_at bigint NOT NULL,
    due_at bigint NOT NULL,
    CHECK ((job = '') <> (batch = ''))
);
CREATE INDEX deliveries_due ON deliveries (due_at);
)sql";

// Empty after a crash: its content distinguishes one life of the server from the next.
constexpr const char* kStep5 = R"sql(
CREATE UNLOGGED TABLE server_life (id uuid NOT NULL, one boolean PRIMARY KEY DEFAULT true CHECK (one));
)sql";

// Entries of a batch that ended in a state that few entries have.
constexpr const char* kStep6 = "CREATE INDEX ended_entries ON ended (status, seq) WHERE NOT single";

// The time before which a job does not start: until then it waits in a class of its own. And an index for counting the
// single jobs of one client; single jobs of low priority share a class with entries of batches.
constexpr const char* kStep7 = R"sql(
ALTER TABLE waiting DROP CONSTRAINT waiting_class_check, ADD CHECK (class IN (0, 1, 2));
ALTER TABLE jobs ADD COLUMN not_before bigint;
CREATE INDEX waiting_clients ON waiting (flow) WHERE class > 0 AND batch IS NULL;
)sql";

constexpr std::array kSteps{kStep1, kStep2, kStep3, kStep4, kStep5, kStep6, kStep7};

[[noreturn]] void refuse(const std::string& sentence) { throw StoreError({StoreFault::Kind::unavailable, sentence}); }

void check_server(Session& session) {
    const pqxx::row row = session.run_plain(
        "SELECT current_setting('server_version_num')::int, "
        "current_setting('server_encoding'), current_database()")[0];
    if (row[0].as<int>() < 130000)
        refuse("the server has version " + std::to_string(row[0].as<int>() / 10000) + "; 13 or newer is needed");
    if (row[1].as<std::string>() != "UTF8")
        refuse("the database " + row[2].as<std::string>() + " has the encoding " + row[1].as<std::string>() +
               "; create one with ENCODING 'UTF8'");
}

void make_schema(Session& session) {
    if (!session.run_plain("SELECT to_regnamespace('tunewright')")[0][0].is_null()) return;
    const pqxx::row may = session.run_plain(
        "SELECT has_database_privilege(current_database(), 'CREATE'), current_database(), current_user")[0];
    if (!may[0].as<bool>())
        refuse("user " + may[2].as<std::string>() + " may not create tables in database " + may[1].as<std::string>() +
               "; let an administrator run CREATE SCHEMA tunewright AUTHORIZATION " + may[2].as<std::string>());
    session.run_plain("CREATE SCHEMA tunewright");
}

}  // namespace

SchemaState schema_state(Session& session) {
    check_server(session);
    SchemaState state{0, static_cast<int>(kSteps.size())};
    if (!session.run_plain("SELECT to_regclass('tunewright.schema_steps')")[0][0].is_null())
        state.have = session.run_plain("SELECT coalesce(max(step), 0) FROM schema_steps")[0][0].as<int>();
    if (state.have > state.known)
        refuse("it has schema " + std::to_string(state.have) + " of a newer program; this one knows " +
               std::to_string(state.known));
    return state;
}

void migrate(Session& session) {
    session.begin();
    session.run_plain("SET LOCAL statement_timeout TO 0; SET LOCAL lock_timeout TO 0");
    session.run_plain(kLock);
    make_schema(session);
    session.run_plain(
        "CREATE TABLE IF NOT EXISTS schema_steps "
        "(step integer PRIMARY KEY, made_at timestamptz NOT NULL DEFAULT now())");
    const SchemaState state = schema_state(session);
    for (int step = state.have; step < state.known; step++) {
        session.run_plain(kSteps[static_cast<std::size_t>(step)]);
        session.run_plain("INSERT INTO schema_steps (step) VALUES (" + std::to_string(step + 1) + ")");
    }
    session.commit();
}

std::string server_life(Session& session) {
    session.run("INSERT INTO server_life (id) VALUES (gen_random_uuid()) ON CONFLICT DO NOTHING");
    return session.run("SELECT id FROM server_life")[0][0].c_str();
}

void grant_use(Session& session, const std::string& role) {
    const std::string name = session.run("SELECT quote_ident($1)", Values().plain(role))[0][0].c_str();
    session.begin();
    session.run_plain("GRANT USAGE ON SCHEMA tunewright TO " + name +
                      "; GRANT SELECT, INSERT, UPDATE, DELETE ON ALL TABLES IN SCHEMA tunewright TO " + name +
                      "; GRANT USAGE ON ALL SEQUENCES IN SCHEMA tunewright TO " + name);
    session.commit();
}

}  // namespace tunewright::server::postgres
