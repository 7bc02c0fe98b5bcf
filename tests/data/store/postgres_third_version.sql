-- The third schema in PostgreSQL, as pg_dump writes it: a job in each state, single and in batches. Never edited.

\restrict X8zt9osckuVRlCVddAEd4WG5eEGiN3nQhOSaRLbTiw0dbIF5edZaiGuOESeKP58

SET statement_timeout = 0;
SET lock_timeout = 0;
SET idle_in_transaction_session_timeout = 0;
SET client_encoding = 'UTF8';
SET standard_conforming_strings = on;
SELECT pg_catalog.set_config('search_path', '', false);
SET check_function_bodies = false;
SET xmloption = content;
SET client_min_messages = warning;
SET row_security = off;

CREATE SCHEMA tunewright;

CREATE FUNCTION tunewright.count_entries_added() RETURNS trigger
    LANGUAGE plpgsql
    AS $$ BEGIN
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

CREATE FUNCTION tunewright.count_entries_moved() RETURNS trigger
    LANGUAGE plpgsql
    AS $$ BEGIN
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

CREATE FUNCTION tunewright.refuse_move() RETURNS trigger
    LANGUAGE plpgsql
    AS $$ BEGIN
    RAISE EXCEPTION 'job % cannot move from % (attempts %) to % (attempts %)',
        OLD.id, OLD.status, OLD.attempts, NEW.status, NEW.attempts USING ERRCODE = 'check_violation';
END $$;

SET default_tablespace = '';

SET default_table_access_method = heap;

CREATE TABLE tunewright.batch_counts (
    batch bigint NOT NULL,
    slot integer NOT NULL,
    queued bigint NOT NULL,
    running bigint NOT NULL,
    succeeded bigint NOT NULL,
    failed bigint NOT NULL,
    cancelled bigint NOT NULL,
    last_end bigint NOT NULL
)
WITH (fillfactor='50');

CREATE TABLE tunewright.batches (
    seq bigint NOT NULL,
    id text NOT NULL COLLATE pg_catalog."C",
    name text NOT NULL,
    owner text NOT NULL,
    flow text NOT NULL,
    created_at bigint NOT NULL,
    heard_at timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    state text DEFAULT 'receiving'::text NOT NULL,
    cancel_requested boolean DEFAULT false NOT NULL,
    request_hash text DEFAULT ''::text NOT NULL,
    idempotency_key text COLLATE pg_catalog."C",
    CONSTRAINT batches_id_check CHECK ((length(id) > 0)),
    CONSTRAINT batches_state_check CHECK ((state = ANY (ARRAY['receiving'::text, 'sealed'::text, 'leaving'::text])))
);

ALTER TABLE tunewright.batches ALTER COLUMN seq ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME tunewright.batches_seq_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE tunewright.jobs (
    seq bigint NOT NULL,
    id text NOT NULL COLLATE pg_catalog."C",
    name text NOT NULL COLLATE pg_catalog."C",
    status text NOT NULL COLLATE pg_catalog."C",
    class smallint NOT NULL,
    turn bigint NOT NULL,
    owner text NOT NULL COLLATE pg_catalog."C",
    flow text NOT NULL COLLATE pg_catalog."C",
    batch bigint,
    batch_index bigint,
    created_at bigint NOT NULL,
    started_at bigint,
    finished_at bigint,
    attempts integer DEFAULT 0 NOT NULL,
    worker text,
    lease_until timestamp with time zone,
    timeout_s double precision NOT NULL,
    request_hash text NOT NULL,
    cancel_requested boolean DEFAULT false NOT NULL,
    version text,
    idempotency_key text COLLATE pg_catalog."C",
    request text,
    result text,
    error text,
    progress text,
    progress_attempts integer,
    crashes integer DEFAULT 0 NOT NULL,
    not_before timestamp with time zone,
    outline text,
    CONSTRAINT jobs_attempts_check CHECK ((attempts >= 0)),
    CONSTRAINT jobs_batch_index_check CHECK ((batch_index >= 0)),
    CONSTRAINT jobs_check CHECK (((finished_at IS NOT NULL) = (status = ANY (ARRAY['succeeded'::text, 'failed'::text, 'cancelled'::text])))),
    CONSTRAINT jobs_check1 CHECK (((status <> 'running'::text) OR ((started_at IS NOT NULL) AND (attempts > 0)))),
    CONSTRAINT jobs_check2 CHECK ((((worker IS NOT NULL) = (status = 'running'::text)) AND ((lease_until IS NOT NULL) = (status = 'running'::text)))),
    CONSTRAINT jobs_check3 CHECK (((status <> 'succeeded'::text) OR (attempts > 0))),
    CONSTRAINT jobs_check4 CHECK (((class =
CASE
    WHEN (batch IS NULL) THEN 0
    ELSE 1
END) AND ((batch IS NULL) = (batch_index IS NULL)))),
    CONSTRAINT jobs_crashes_check CHECK ((crashes >= 0)),
    CONSTRAINT jobs_id_check CHECK ((length(id) > 0)),
    CONSTRAINT jobs_status_check CHECK ((status = ANY (ARRAY['queued'::text, 'running'::text, 'succeeded'::text, 'failed'::text, 'cancelled'::text]))),
    CONSTRAINT jobs_timeout_s_check CHECK ((timeout_s > (0)::double precision))
)
WITH (autovacuum_vacuum_scale_factor='0.05', autovacuum_analyze_scale_factor='0.05');
ALTER TABLE ONLY tunewright.jobs ALTER COLUMN request SET COMPRESSION lz4;
ALTER TABLE ONLY tunewright.jobs ALTER COLUMN result SET COMPRESSION lz4;

ALTER TABLE tunewright.jobs ALTER COLUMN seq ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME tunewright.jobs_seq_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE tunewright.schema_steps (
    step integer NOT NULL,
    made_at timestamp with time zone DEFAULT now() NOT NULL
);

INSERT INTO tunewright.batch_counts VALUES (1, 48, 2, 0, 0, 1, 0, 1795453490960);
INSERT INTO tunewright.batch_counts VALUES (1, 43, -2, 0, 2, 0, 0, 1795453490971);
INSERT INTO tunewright.batch_counts VALUES (2, 5, 4, 0, 0, 0, 0, 0);

INSERT INTO tunewright.batches OVERRIDING SYSTEM VALUE VALUES (1, '3034922d8cpm8yq55ctb4e176y', 'ended', '', '127.0.0.1', 1795453490960, '2026-11-23 17:04:50.956275+00', 'sealed', false, '16d9740331083c4686ddd68302bb9245782b6da14f4af1b3164e0eb46d4706c3', 'batch-1');
INSERT INTO tunewright.batches OVERRIDING SYSTEM VALUE VALUES (2, 'meen3q439hk37cry0gdf2hz19j', 'waiting', '', '127.0.0.1', 1795453492597, '2026-11-23 17:04:52.597525+00', 'sealed', false, 'cbbff42d6a5a56d488227f0ad6997ce548baceaf96f639f647dffb7c935f1277', NULL);

INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (1, 'jwk3k242ss48zn2y7sn12pwjsp', 'succeeded', 'succeeded', 0, 1, '', '127.0.0.1', NULL, NULL, 1795453490717, 1795453490719, 1795453490733, 1, NULL, NULL, 60, '0527aa53eaecab69e1a5d8e5c0891cbd2e0de04e3adb1364de26fca976cbd7ee', false, '0.1.0', 'key-1', '{"plant":{"type":"fopdt","K":2,"T":10,"L":3},"tune":[{"method":"simc"}],"evaluate":{"points":0},"name":"succeeded"}', '{"controllers":[{"method":"simc","title":"SIMC (Skogestad)","source":"Skogestad, J. Process Control 13 (2003) 291-309, Table 1","options":{"controller":"PID"},"verdict":[{"code":"robust","level":"good","text":"Robust.","figures":{}},{"code":"peaks","level":"note","text":"Ms is 1.59 at 0.381 rad/s, Mt 1.00.","figures":{"Ms":1.590490233189583,"Mt":1,"omega_Ms":0.381411246638331}},{"code":"margins","level":"note","text":"The process gain may grow 3.14-fold, or the dead time by 6.42 s, before the loop oscillates.","figures":{"extra_dead_time":6.4247779607693785,"gain_high":3.1415926535897927}},{"code":"load-error","level":"note","text":"A load step gives an integrated absolute error of 12.0 s.","figures":{"load_IAE":12}}],"warnings":[{"code":"no-derivative","detail":"The model has no second lag, for which SIMC has no derivative action: the answer is a PI controller.","level":"warning"}],"controller":{"form":"ideal","Kp":0.8333333333333334,"Ti":10,"Td":0,"b":1,"c":0,"filter":{"type":"none"},"action":"reverse"},"equivalents":{"parallel":{"form":"parallel","Kp":0.8333333333333334,"Ki":0.08333333333333334,"Kd":0,"b":1,"c":0,"filter":{"type":"none"},"action":"reverse"},"series":{"form":"series","Kp":0.8333333333333334,"Ti":10,"Td":0,"b":1,"c":0,"filter":{"type":"none"},"action":"reverse","b_equivalent":1}},"robustness":{"stable":true,"Ms":1.590490233189583,"omega_Ms":0.381411246638331,"Mt":1,"omega_Mt":0,"Mks":1.3718887963814599,"gain_margin":3.1415926535897927,"gain_margin_low":null,"phase_margin_deg":61.35211024345884,"delay_margin":6.4247779607693785,"gain_crossover":0.16666666666666669,"phase_crossover":0.5235987755982988,"binding":"Ms at omega 0.381","tolerates":{"gain":[0,3.1415926535897927],"extra_dead_time":6.4247779607693785},"why_null":{"gain_margin_low":"No lower gain loses stability."}},"performance":{"setpoint":{"IAE":6.506071814156304,"ISE":5.057389341582969,"ITAE":25.901354209167902,"overshoot_percent":4.051968299012443,"rise_time":5.716390576884539,"rise_time_5_95":6.784072376396117,"settling_time":18.169340781758613,"TV":1.7125164720915693,"first_move":0.8333333333333334},"load":{"IAE":12,"ISE":5.910895372885736,"ITAE":192.00001668156602,"peak":0.7744529635941073,"recovery_time":49.37533239861615,"TV":1.0843454326980497}},"verification":{"setpoint_errors":{"IAE":8.276667158952864e-09,"ISE":2.6912755168440065e-07,"ITAE":9.610454328627264e-06,"TV":2.0529532336002526e-06},"load_errors":{"IAE":0,"ISE":6.893813248580747e-06,"ITAE":1.8332698493907893e-06,"TV":2.0098366710283165e-05},"iae_step_halving":0,"load_error_keeps_sign":true,"ie_identity":2.487147821028657e-09,"ms_grid_difference":2.220446049250313e-16,"stability_methods_agree":true},"longest_sample_time":0.46580491211813424,"standing":{"settles":true,"Ms":1.590490233189583,"within":true,"excess_percent":null,"why_null":{"excess_percent":"It was not compared with an optimum."}},"compute_ms":0.6527500003576279}],"verdict":[{"code":"take","level":"good","text":"Take SIMC (Skogestad). Robust.","figures":{"entry":0}},{"code":"load-error","level":"note","text":"A load step gives an integrated absolute error of 12.0 s.","figures":{"load_IAE":12}}],"ranking":[0],"ranking_by":"load IAE, among stable entries that settle with Ms <= 2, then the rest","partial":false,"version":"0.1.0","request_hash":"0527aa53eaecab69e1a5d8e5c0891cbd2e0de04e3adb1364de26fca976cbd7ee","seed":0}', NULL, NULL, NULL, 0, NULL, '{"plant":{"type":"fopdt","K":2,"T":10,"L":3},"entries":1,"method":"simc","Ms":1.590490233189583,"load_IAE":12}');
INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (2, 'ce05gbr5h69tgxhmt34jn7tq80', 'failed', 'failed', 0, 1, '', '127.0.0.1', NULL, NULL, 1795453490744, 1795453490746, 1795453490904, 1, NULL, NULL, 0.05, '2d579e265ba38e5886b1f58372ad14ba0726944540b8e815f731e29349c3fbd8', false, '0.1.0', NULL, '{"name":"failed","plant":{"type":"zpk","zeros":[],"poles":[-1,-1.1,-1.2,-1.3,-1.4,-1.5],"K":7.2,"L":0.5},"tune":[{"method":"robust","search":"grid","surface":true,"Ms":1.2},{"method":"robust","search":"grid","surface":true,"Ms":1.22},{"method":"robust","search":"grid","surface":true,"Ms":1.24},{"method":"robust","search":"grid","surface":true,"Ms":1.26},{"method":"robust","search":"grid","surface":true,"Ms":1.28},{"method":"robust","search":"grid","surface":true,"Ms":1.3},{"method":"robust","search":"grid","surface":true,"Ms":1.3199999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.3399999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.3599999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.38},{"method":"robust","search":"grid","surface":true,"Ms":1.4},{"method":"robust","search":"grid","surface":true,"Ms":1.42},{"method":"robust","search":"grid","surface":true,"Ms":1.44},{"method":"robust","search":"grid","surface":true,"Ms":1.46},{"method":"robust","search":"grid","surface":true,"Ms":1.48},{"method":"robust","search":"grid","surface":true,"Ms":1.5},{"method":"robust","search":"grid","surface":true,"Ms":1.52},{"method":"robust","search":"grid","surface":true,"Ms":1.54},{"method":"robust","search":"grid","surface":true,"Ms":1.56},{"method":"robust","search":"grid","surface":true,"Ms":1.58},{"method":"robust","search":"grid","surface":true,"Ms":1.6},{"method":"robust","search":"grid","surface":true,"Ms":1.6199999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.64},{"method":"robust","search":"grid","surface":true,"Ms":1.66},{"method":"robust","search":"grid","surface":true,"Ms":1.68},{"method":"robust","search":"grid","surface":true,"Ms":1.7},{"method":"robust","search":"grid","surface":true,"Ms":1.72},{"method":"robust","search":"grid","surface":true,"Ms":1.74},{"method":"robust","search":"grid","surface":true,"Ms":1.76},{"method":"robust","search":"grid","surface":true,"Ms":1.7799999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.7999999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.8199999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.8399999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.8599999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.88},{"method":"robust","search":"grid","surface":true,"Ms":1.9},{"method":"robust","search":"grid","surface":true,"Ms":1.92},{"method":"robust","search":"grid","surface":true,"Ms":1.94},{"method":"robust","search":"grid","surface":true,"Ms":1.96},{"method":"robust","search":"grid","surface":true,"Ms":1.98}],"timeout_s":0.05}', '{"controllers": []}', '{"type":"timeout","title":"The time allowed is over","status":504,"detail":"The job was stopped after timeout_s = 0.05 s. Ask for fewer methods or a simpler search, or raise timeout_s.","errors":[{"pointer":"/timeout_s","detail":"The job was stopped after timeout_s = 0.05 s. Ask for fewer methods or a simpler search, or raise timeout_s."}]}', NULL, NULL, 0, NULL, '{"plant":{"type":"zpk","K":7.2,"zeros":[],"poles":[-1,-1.1,-1.2,-1.3,-1.4,-1.5],"L":0.5},"entries":1,"method":"robust","Ms":1.1999999880044894,"load_IAE":17.686221834327846}');
INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (3, 'wnhppaj53rsay52j6cpmn60bq9', 'cancelled', 'cancelled', 0, 1, '', '127.0.0.1', NULL, NULL, 1795453490914, 1795453490917, 1795453490950, 1, NULL, NULL, 600, '7abec5ae37ac367767c43c9fa6d2a47874c703bc7baf83f516eadd8e1b0aa434', true, '0.1.0', NULL, '{"name":"cancelled","plant":{"type":"zpk","zeros":[],"poles":[-1,-1.1,-1.2,-1.3,-1.4,-1.5],"K":7.2,"L":0.5},"tune":[{"method":"robust","search":"grid","surface":true,"Ms":1.2},{"method":"robust","search":"grid","surface":true,"Ms":1.22},{"method":"robust","search":"grid","surface":true,"Ms":1.24},{"method":"robust","search":"grid","surface":true,"Ms":1.26},{"method":"robust","search":"grid","surface":true,"Ms":1.28},{"method":"robust","search":"grid","surface":true,"Ms":1.3},{"method":"robust","search":"grid","surface":true,"Ms":1.3199999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.3399999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.3599999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.38},{"method":"robust","search":"grid","surface":true,"Ms":1.4},{"method":"robust","search":"grid","surface":true,"Ms":1.42},{"method":"robust","search":"grid","surface":true,"Ms":1.44},{"method":"robust","search":"grid","surface":true,"Ms":1.46},{"method":"robust","search":"grid","surface":true,"Ms":1.48},{"method":"robust","search":"grid","surface":true,"Ms":1.5},{"method":"robust","search":"grid","surface":true,"Ms":1.52},{"method":"robust","search":"grid","surface":true,"Ms":1.54},{"method":"robust","search":"grid","surface":true,"Ms":1.56},{"method":"robust","search":"grid","surface":true,"Ms":1.58},{"method":"robust","search":"grid","surface":true,"Ms":1.6},{"method":"robust","search":"grid","surface":true,"Ms":1.6199999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.64},{"method":"robust","search":"grid","surface":true,"Ms":1.66},{"method":"robust","search":"grid","surface":true,"Ms":1.68},{"method":"robust","search":"grid","surface":true,"Ms":1.7},{"method":"robust","search":"grid","surface":true,"Ms":1.72},{"method":"robust","search":"grid","surface":true,"Ms":1.74},{"method":"robust","search":"grid","surface":true,"Ms":1.76},{"method":"robust","search":"grid","surface":true,"Ms":1.7799999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.7999999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.8199999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.8399999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.8599999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.88},{"method":"robust","search":"grid","surface":true,"Ms":1.9},{"method":"robust","search":"grid","surface":true,"Ms":1.92},{"method":"robust","search":"grid","surface":true,"Ms":1.94},{"method":"robust","search":"grid","surface":true,"Ms":1.96},{"method":"robust","search":"grid","surface":true,"Ms":1.98}],"timeout_s":600}', '{"controllers": []}', NULL, NULL, NULL, 0, NULL, '{"plant":{"type":"zpk","K":7.2,"zeros":[],"poles":[-1,-1.1,-1.2,-1.3,-1.4,-1.5],"L":0.5},"entries":1,"method":"robust","Ms":1.1999999880025405,"load_IAE":43.96988121683444}');
INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (5, '004g1tdvry5prb06n8zgg2p26e', '', 'failed', 1, 1, '', '127.0.0.1', 1, 1, 1795453490960, NULL, 1795453490960, 0, NULL, NULL, 60, '', false, NULL, NULL, NULL, NULL, '{"type":"invalid-request","title":"The request is not valid","status":422,"detail":"Request 2, line 2: type is \"nothing\"; it must be fopdt, sopdt, ipdt, transfer_function, zpk, state_space, set, frequency_response or nonlinear.","errors":[{"pointer":"/plant/type","detail":"type is \"nothing\"; it must be fopdt, sopdt, ipdt, transfer_function, zpk, state_space, set, frequency_response or nonlinear."}]}', NULL, NULL, 0, NULL, '{"error":"type is \"nothing\"; it must be fopdt, sopdt, ipdt, transfer_function, zpk, state_space, set, frequency_response or nonlinear."}');
INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (6, 'vp1ta7tjvdgdv37d2zj26fcj4e', '', 'succeeded', 1, 2, '', '127.0.0.1', 1, 2, 1795453490960, 1795453490968, 1795453490970, 1, NULL, NULL, 60, '33ef9f26c1a03dbe415a680833e02ac35cf125afd7cd600b2ec56d7ec041c685', false, '0.1.0', NULL, '{"plant":{"type":"fopdt","K":2,"T":10,"L":3},"tune":[{"method":"simc"}],"evaluate":{"points":0}}', '{"controllers":[{"method":"simc","title":"SIMC (Skogestad)","source":"Skogestad, J. Process Control 13 (2003) 291-309, Table 1","options":{"controller":"PID"},"verdict":[{"code":"robust","level":"good","text":"Robust.","figures":{}},{"code":"peaks","level":"note","text":"Ms is 1.59 at 0.381 rad/s, Mt 1.00.","figures":{"Ms":1.590490233189583,"Mt":1,"omega_Ms":0.381411246638331}},{"code":"margins","level":"note","text":"The process gain may grow 3.14-fold, or the dead time by 6.42 s, before the loop oscillates.","figures":{"extra_dead_time":6.4247779607693785,"gain_high":3.1415926535897927}},{"code":"load-error","level":"note","text":"A load step gives an integrated absolute error of 12.0 s.","figures":{"load_IAE":12}}],"warnings":[{"code":"no-derivative","detail":"The model has no second lag, for which SIMC has no derivative action: the answer is a PI controller.","level":"warning"}],"controller":{"form":"ideal","Kp":0.8333333333333334,"Ti":10,"Td":0,"b":1,"c":0,"filter":{"type":"none"},"action":"reverse"},"equivalents":{"parallel":{"form":"parallel","Kp":0.8333333333333334,"Ki":0.08333333333333334,"Kd":0,"b":1,"c":0,"filter":{"type":"none"},"action":"reverse"},"series":{"form":"series","Kp":0.8333333333333334,"Ti":10,"Td":0,"b":1,"c":0,"filter":{"type":"none"},"action":"reverse","b_equivalent":1}},"robustness":{"stable":true,"Ms":1.590490233189583,"omega_Ms":0.381411246638331,"Mt":1,"omega_Mt":0,"Mks":1.3718887963814599,"gain_margin":3.1415926535897927,"gain_margin_low":null,"phase_margin_deg":61.35211024345884,"delay_margin":6.4247779607693785,"gain_crossover":0.16666666666666669,"phase_crossover":0.5235987755982988,"binding":"Ms at omega 0.381","tolerates":{"gain":[0,3.1415926535897927],"extra_dead_time":6.4247779607693785},"why_null":{"gain_margin_low":"No lower gain loses stability."}},"performance":{"setpoint":{"IAE":6.506071814156304,"ISE":5.057389341582969,"ITAE":25.901354209167902,"overshoot_percent":4.051968299012443,"rise_time":5.716390576884539,"rise_time_5_95":6.784072376396117,"settling_time":18.169340781758613,"TV":1.7125164720915693,"first_move":0.8333333333333334},"load":{"IAE":12,"ISE":5.910895372885736,"ITAE":192.00001668156602,"peak":0.7744529635941073,"recovery_time":49.37533239861615,"TV":1.0843454326980497}},"verification":{"setpoint_errors":{"IAE":8.276667158952864e-09,"ISE":2.6912755168440065e-07,"ITAE":9.610454328627264e-06,"TV":2.0529532336002526e-06},"load_errors":{"IAE":0,"ISE":6.893813248580747e-06,"ITAE":1.8332698493907893e-06,"TV":2.0098366710283165e-05},"iae_step_halving":0,"load_error_keeps_sign":true,"ie_identity":2.487147821028657e-09,"ms_grid_difference":2.220446049250313e-16,"stability_methods_agree":true},"longest_sample_time":0.46580491211813424,"standing":{"settles":true,"Ms":1.590490233189583,"within":true,"excess_percent":null,"why_null":{"excess_percent":"It was not compared with an optimum."}},"compute_ms":0.35474200174212456}],"verdict":[{"code":"take","level":"good","text":"Take SIMC (Skogestad). Robust.","figures":{"entry":0}},{"code":"load-error","level":"note","text":"A load step gives an integrated absolute error of 12.0 s.","figures":{"load_IAE":12}}],"ranking":[0],"ranking_by":"load IAE, among stable entries that settle with Ms <= 2, then the rest","partial":false,"version":"0.1.0","request_hash":"33ef9f26c1a03dbe415a680833e02ac35cf125afd7cd600b2ec56d7ec041c685","seed":0}', NULL, NULL, NULL, 0, NULL, '{"plant":{"type":"fopdt","K":2,"T":10,"L":3},"entries":1,"method":"simc","Ms":1.590490233189583,"load_IAE":12}');
INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (4, 'm8r4p5asp7bbb18krdfx7fz9cg', '', 'succeeded', 1, 1, '', '127.0.0.1', 1, 0, 1795453490960, 1795453490968, 1795453490971, 1, NULL, NULL, 60, '33ef9f26c1a03dbe415a680833e02ac35cf125afd7cd600b2ec56d7ec041c685', false, '0.1.0', NULL, '{"plant":{"type":"fopdt","K":2,"T":10,"L":3},"tune":[{"method":"simc"}],"evaluate":{"points":0}}', '{"controllers":[{"method":"simc","title":"SIMC (Skogestad)","source":"Skogestad, J. Process Control 13 (2003) 291-309, Table 1","options":{"controller":"PID"},"verdict":[{"code":"robust","level":"good","text":"Robust.","figures":{}},{"code":"peaks","level":"note","text":"Ms is 1.59 at 0.381 rad/s, Mt 1.00.","figures":{"Ms":1.590490233189583,"Mt":1,"omega_Ms":0.381411246638331}},{"code":"margins","level":"note","text":"The process gain may grow 3.14-fold, or the dead time by 6.42 s, before the loop oscillates.","figures":{"extra_dead_time":6.4247779607693785,"gain_high":3.1415926535897927}},{"code":"load-error","level":"note","text":"A load step gives an integrated absolute error of 12.0 s.","figures":{"load_IAE":12}}],"warnings":[{"code":"no-derivative","detail":"The model has no second lag, for which SIMC has no derivative action: the answer is a PI controller.","level":"warning"}],"controller":{"form":"ideal","Kp":0.8333333333333334,"Ti":10,"Td":0,"b":1,"c":0,"filter":{"type":"none"},"action":"reverse"},"equivalents":{"parallel":{"form":"parallel","Kp":0.8333333333333334,"Ki":0.08333333333333334,"Kd":0,"b":1,"c":0,"filter":{"type":"none"},"action":"reverse"},"series":{"form":"series","Kp":0.8333333333333334,"Ti":10,"Td":0,"b":1,"c":0,"filter":{"type":"none"},"action":"reverse","b_equivalent":1}},"robustness":{"stable":true,"Ms":1.590490233189583,"omega_Ms":0.381411246638331,"Mt":1,"omega_Mt":0,"Mks":1.3718887963814599,"gain_margin":3.1415926535897927,"gain_margin_low":null,"phase_margin_deg":61.35211024345884,"delay_margin":6.4247779607693785,"gain_crossover":0.16666666666666669,"phase_crossover":0.5235987755982988,"binding":"Ms at omega 0.381","tolerates":{"gain":[0,3.1415926535897927],"extra_dead_time":6.4247779607693785},"why_null":{"gain_margin_low":"No lower gain loses stability."}},"performance":{"setpoint":{"IAE":6.506071814156304,"ISE":5.057389341582969,"ITAE":25.901354209167902,"overshoot_percent":4.051968299012443,"rise_time":5.716390576884539,"rise_time_5_95":6.784072376396117,"settling_time":18.169340781758613,"TV":1.7125164720915693,"first_move":0.8333333333333334},"load":{"IAE":12,"ISE":5.910895372885736,"ITAE":192.00001668156602,"peak":0.7744529635941073,"recovery_time":49.37533239861615,"TV":1.0843454326980497}},"verification":{"setpoint_errors":{"IAE":8.276667158952864e-09,"ISE":2.6912755168440065e-07,"ITAE":9.610454328627264e-06,"TV":2.0529532336002526e-06},"load_errors":{"IAE":0,"ISE":6.893813248580747e-06,"ITAE":1.8332698493907893e-06,"TV":2.0098366710283165e-05},"iae_step_halving":0,"load_error_keeps_sign":true,"ie_identity":2.487147821028657e-09,"ms_grid_difference":2.220446049250313e-16,"stability_methods_agree":true},"longest_sample_time":0.46580491211813424,"standing":{"settles":true,"Ms":1.590490233189583,"within":true,"excess_percent":null,"why_null":{"excess_percent":"It was not compared with an optimum."}},"compute_ms":1.0705379992723465}],"verdict":[{"code":"take","level":"good","text":"Take SIMC (Skogestad). Robust.","figures":{"entry":0}},{"code":"load-error","level":"note","text":"A load step gives an integrated absolute error of 12.0 s.","figures":{"load_IAE":12}}],"ranking":[0],"ranking_by":"load IAE, among stable entries that settle with Ms <= 2, then the rest","partial":false,"version":"0.1.0","request_hash":"33ef9f26c1a03dbe415a680833e02ac35cf125afd7cd600b2ec56d7ec041c685","seed":0}', NULL, NULL, NULL, 0, NULL, '{"plant":{"type":"fopdt","K":2,"T":10,"L":3},"entries":1,"method":"simc","Ms":1.590490233189583,"load_IAE":12}');
INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (7, '9fm5bp6cydpwxzx9e5w5fxnxak', 'running', 'running', 0, 1, '', '127.0.0.1', NULL, NULL, 1795453490977, 1795453490978, NULL, 1, 'j5kmwztqpx8s0f08wj0n4sje36', '2026-11-23 17:05:02.218077+00', 600, '7340d5b8ccead185032c0b0b9ee50155fa9f04777a8a4f4dbddd276423e2f383', false, NULL, NULL, '{"name":"running","plant":{"type":"zpk","zeros":[],"poles":[-1,-1.1,-1.2,-1.3,-1.4,-1.5],"K":7.2,"L":0.5},"tune":[{"method":"robust","search":"grid","surface":true,"Ms":1.2},{"method":"robust","search":"grid","surface":true,"Ms":1.22},{"method":"robust","search":"grid","surface":true,"Ms":1.24},{"method":"robust","search":"grid","surface":true,"Ms":1.26},{"method":"robust","search":"grid","surface":true,"Ms":1.28},{"method":"robust","search":"grid","surface":true,"Ms":1.3},{"method":"robust","search":"grid","surface":true,"Ms":1.3199999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.3399999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.3599999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.38},{"method":"robust","search":"grid","surface":true,"Ms":1.4},{"method":"robust","search":"grid","surface":true,"Ms":1.42},{"method":"robust","search":"grid","surface":true,"Ms":1.44},{"method":"robust","search":"grid","surface":true,"Ms":1.46},{"method":"robust","search":"grid","surface":true,"Ms":1.48},{"method":"robust","search":"grid","surface":true,"Ms":1.5},{"method":"robust","search":"grid","surface":true,"Ms":1.52},{"method":"robust","search":"grid","surface":true,"Ms":1.54},{"method":"robust","search":"grid","surface":true,"Ms":1.56},{"method":"robust","search":"grid","surface":true,"Ms":1.58},{"method":"robust","search":"grid","surface":true,"Ms":1.6},{"method":"robust","search":"grid","surface":true,"Ms":1.6199999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.64},{"method":"robust","search":"grid","surface":true,"Ms":1.66},{"method":"robust","search":"grid","surface":true,"Ms":1.68},{"method":"robust","search":"grid","surface":true,"Ms":1.7},{"method":"robust","search":"grid","surface":true,"Ms":1.72},{"method":"robust","search":"grid","surface":true,"Ms":1.74},{"method":"robust","search":"grid","surface":true,"Ms":1.76},{"method":"robust","search":"grid","surface":true,"Ms":1.7799999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.7999999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.8199999999999998},{"method":"robust","search":"grid","surface":true,"Ms":1.8399999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.8599999999999999},{"method":"robust","search":"grid","surface":true,"Ms":1.88},{"method":"robust","search":"grid","surface":true,"Ms":1.9},{"method":"robust","search":"grid","surface":true,"Ms":1.92},{"method":"robust","search":"grid","surface":true,"Ms":1.94},{"method":"robust","search":"grid","surface":true,"Ms":1.96},{"method":"robust","search":"grid","surface":true,"Ms":1.98}],"timeout_s":600}', NULL, NULL, '{"fraction":0.022498179379162264,"stage":"tune","message":"robust design: 79 improvements so far.","best":{"controller":{"form":"ideal","Kp":0.1860161086429251,"Ti":2.586141258518161,"Td":1.8702201155949332,"b":1,"c":0,"filter":{"type":"measurement_second_order","Tf":0.18702201155949333},"action":"reverse"},"load_IAE":14.744042907741635,"Ms":1.24,"Mt":1.4}}', 1, 0, NULL, NULL);
INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (8, 'gxcq3nknhxbj5n272wwgt6hmca', 'queued', 'queued', 0, 2, '', '127.0.0.1', NULL, NULL, 1795453492590, NULL, NULL, 0, NULL, NULL, 60, '116aab65b6136b1af0931981d2e1bb8eff32727a5c70c89fd5845055d8070007', false, NULL, 'key-2', '{"plant":{"type":"fopdt","K":2,"T":10,"L":3},"tune":[{"method":"simc"}],"evaluate":{"points":0},"name":"queued"}', NULL, NULL, NULL, NULL, 0, NULL, NULL);
INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (9, 'zxhtc3zc0pc3nke027mmmhx691', '', 'queued', 1, 1, '', '127.0.0.1', 2, 0, 1795453492597, NULL, NULL, 0, NULL, NULL, 60, '33ef9f26c1a03dbe415a680833e02ac35cf125afd7cd600b2ec56d7ec041c685', false, NULL, NULL, '{"plant":{"type":"fopdt","K":2,"T":10,"L":3},"tune":[{"method":"simc"}],"evaluate":{"points":0}}', NULL, NULL, NULL, NULL, 0, NULL, NULL);
INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (10, 'jerw8fpn6bnwccsngdzra2papy', '', 'queued', 1, 2, '', '127.0.0.1', 2, 1, 1795453492597, NULL, NULL, 0, NULL, NULL, 60, '33ef9f26c1a03dbe415a680833e02ac35cf125afd7cd600b2ec56d7ec041c685', false, NULL, NULL, '{"plant":{"type":"fopdt","K":2,"T":10,"L":3},"tune":[{"method":"simc"}],"evaluate":{"points":0}}', NULL, NULL, NULL, NULL, 0, NULL, NULL);
INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (11, 'zhm5zm7w16zvr1r3gm2yn2mn0b', '', 'queued', 1, 3, '', '127.0.0.1', 2, 2, 1795453492597, NULL, NULL, 0, NULL, NULL, 60, '33ef9f26c1a03dbe415a680833e02ac35cf125afd7cd600b2ec56d7ec041c685', false, NULL, NULL, '{"plant":{"type":"fopdt","K":2,"T":10,"L":3},"tune":[{"method":"simc"}],"evaluate":{"points":0}}', NULL, NULL, NULL, NULL, 0, NULL, NULL);
INSERT INTO tunewright.jobs OVERRIDING SYSTEM VALUE VALUES (12, 'sfg49f0y0d3w6vfpncr8hcqvee', '', 'queued', 1, 4, '', '127.0.0.1', 2, 3, 1795453492597, NULL, NULL, 0, NULL, NULL, 60, '33ef9f26c1a03dbe415a680833e02ac35cf125afd7cd600b2ec56d7ec041c685', false, NULL, NULL, '{"plant":{"type":"fopdt","K":2,"T":10,"L":3},"tune":[{"method":"simc"}],"evaluate":{"points":0}}', NULL, NULL, NULL, NULL, 0, NULL, NULL);

INSERT INTO tunewright.schema_steps VALUES (1, '2026-11-23 17:04:50.510379+00');
INSERT INTO tunewright.schema_steps VALUES (2, '2026-11-23 17:04:50.510379+00');
INSERT INTO tunewright.schema_steps VALUES (3, '2026-11-23 17:04:50.510379+00');

SELECT pg_catalog.setval('tunewright.batches_seq_seq', 2, true);

SELECT pg_catalog.setval('tunewright.jobs_seq_seq', 12, true);

ALTER TABLE ONLY tunewright.batch_counts
    ADD CONSTRAINT batch_counts_pkey PRIMARY KEY (batch, slot);

ALTER TABLE ONLY tunewright.batches
    ADD CONSTRAINT batches_id_key UNIQUE (id);

ALTER TABLE ONLY tunewright.batches
    ADD CONSTRAINT batches_owner_idempotency_key_key UNIQUE (owner, idempotency_key);

ALTER TABLE ONLY tunewright.batches
    ADD CONSTRAINT batches_pkey PRIMARY KEY (seq);

ALTER TABLE ONLY tunewright.jobs
    ADD CONSTRAINT jobs_id_key UNIQUE (id);

ALTER TABLE ONLY tunewright.jobs
    ADD CONSTRAINT jobs_pkey PRIMARY KEY (seq);

ALTER TABLE ONLY tunewright.schema_steps
    ADD CONSTRAINT schema_steps_pkey PRIMARY KEY (step);

CREATE INDEX batches_unsettled ON tunewright.batches USING btree (state) WHERE ((state <> 'sealed'::text) OR cancel_requested);

CREATE UNIQUE INDEX jobs_by_batch ON tunewright.jobs USING btree (batch, batch_index) WHERE (batch IS NOT NULL);

CREATE INDEX jobs_by_end ON tunewright.jobs USING btree (finished_at) WHERE ((class = 0) AND (finished_at IS NOT NULL));

CREATE UNIQUE INDEX jobs_by_key ON tunewright.jobs USING btree (owner, idempotency_key) WHERE (idempotency_key IS NOT NULL);

CREATE INDEX jobs_by_name ON tunewright.jobs USING btree (name, seq) WHERE (class = 0);

CREATE INDEX jobs_by_owner ON tunewright.jobs USING btree (owner, seq) WHERE (class = 0);

CREATE INDEX jobs_by_status ON tunewright.jobs USING btree (status, seq) WHERE (class = 0);

CREATE INDEX jobs_flows ON tunewright.jobs USING btree (class, flow, turn) WHERE (status = 'queued'::text);

CREATE INDEX jobs_running ON tunewright.jobs USING btree (class, turn) WHERE (status = 'running'::text);

CREATE INDEX jobs_single ON tunewright.jobs USING btree (seq) WHERE (class = 0);

CREATE INDEX jobs_suspect ON tunewright.jobs USING btree (not_before) WHERE ((status = 'queued'::text) AND (crashes > 1));

CREATE INDEX jobs_waiting ON tunewright.jobs USING btree (class, turn, seq) WHERE (status = 'queued'::text);

CREATE TRIGGER entries_added AFTER INSERT ON tunewright.jobs REFERENCING NEW TABLE AS new_rows FOR EACH STATEMENT EXECUTE FUNCTION tunewright.count_entries_added();

CREATE TRIGGER entries_moved AFTER UPDATE ON tunewright.jobs REFERENCING OLD TABLE AS old_rows NEW TABLE AS new_rows FOR EACH STATEMENT EXECUTE FUNCTION tunewright.count_entries_moved();

CREATE TRIGGER jobs_move BEFORE UPDATE ON tunewright.jobs FOR EACH ROW WHEN ((((old.status <> new.status) AND (old.status = ANY (ARRAY['succeeded'::text, 'failed'::text, 'cancelled'::text]))) OR ((old.status = 'queued'::text) AND (new.status = ANY (ARRAY['succeeded'::text, 'failed'::text]))) OR (new.attempts <> (old.attempts +
        CASE
            WHEN ((old.status = 'queued'::text) AND (new.status = 'running'::text)) THEN 1
            ELSE 0
        END)))) EXECUTE FUNCTION tunewright.refuse_move();

ALTER TABLE ONLY tunewright.batch_counts
    ADD CONSTRAINT batch_counts_batch_fkey FOREIGN KEY (batch) REFERENCES tunewright.batches(seq) ON DELETE CASCADE;

\unrestrict X8zt9osckuVRlCVddAEd4WG5eEGiN3nQhOSaRLbTiw0dbIF5edZaiGuOESeKP58

