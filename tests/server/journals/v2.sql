BEGIN TRANSACTION;
CREATE TABLE documents (
    kind TEXT NOT NULL,
    name TEXT NOT NULL,
    text TEXT NOT NULL,
    PRIMARY KEY (kind, name)
) STRICT;
INSERT INTO "documents" VALUES('tree','mine','then:
- {behavior: pick_and_place, object: pink_bar}
');
CREATE TABLE events (
    seq INTEGER PRIMARY KEY,
    run TEXT NOT NULL,
    type TEXT NOT NULL,
    time REAL NOT NULL,
    version INTEGER NOT NULL,
    body TEXT NOT NULL
) STRICT;
INSERT INTO "events" VALUES(1,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_started',0.5,1,'{"seq":1,"time":0.5,"wall_time":"2026-01-02T03:04:01Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_started","tree_name":"eket","tree":{"name":"eket","scene":"eket","then":[{"behavior":"pick_and_place","object":"pink_bar","place":"pink_place"}]},"scene":{"name":"eket","objects":{},"places":{}},"world":"workcell","robots":["robot"],"seed":7,"speed":"max","scenario":"eket_paper","script":{"name":"eket_paper","tree":"eket"},"options":{"max_attempts":3}}');
INSERT INTO "events" VALUES(2,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_started',1.0,1,'{"seq":2,"time":1.0,"wall_time":"2026-01-02T03:04:02Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_started","robot":"robot","boot":"boot-1","execution":"5d0f2c1e-0a44-4a0c-8a3e-9f6f3f2b1a01","attempt":1,"candidates":[{"node":"/1/0","name":"pink_bar","level":0.5,"potential":1.7,"attempts":0}]}');
INSERT INTO "events" VALUES(3,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','step_started',1.5,1,'{"seq":3,"time":1.5,"wall_time":"2026-01-02T03:04:03Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"step_started","robot":"robot","execution":"5d0f2c1e-0a44-4a0c-8a3e-9f6f3f2b1a01","step":4,"step_name":"above pick"}');
INSERT INTO "events" VALUES(4,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','issue_raised',2.0,1,'{"seq":4,"time":2.0,"wall_time":"2026-01-02T03:04:04Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"issue_raised","robot":"robot","issue":"dropped","object":"pink_bar","place":"pink_place","execution":"5d0f2c1e-0a44-4a0c-8a3e-9f6f3f2b1a01","step":4,"interrupts":true,"detection":{"camera":"forearm","size_px":null,"center":null,"expected":[160.0,120.0],"tolerance_px":40.0,"area_px":0,"explanation":"no blob is left"},"picture":"3e2d1c0b-9a8f-4e7d-8c6b-5a4f3e2d1c04"}');
INSERT INTO "events" VALUES(5,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot_holding',2.5,1,'{"seq":5,"time":2.5,"wall_time":"2026-01-02T03:04:05Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"robot_holding","at":"neutral"}');
INSERT INTO "events" VALUES(6,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','dialogue_opened',3.0,1,'{"seq":6,"time":3.0,"wall_time":"2026-01-02T03:04:06Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"dialogue_opened"}');
INSERT INTO "events" VALUES(7,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','prompt',3.5,1,'{"seq":7,"time":3.5,"wall_time":"2026-01-02T03:04:07Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"prompt","prompt":"9a3b1c2d-1f2e-4d3c-8b4a-6e5f7a8b9c03","version":1,"kind":"ask","text":"I dropped the pink bar. Shall I try again?","answers":[{"value":"yes","effect":"The robot tries again.","final":false},{"value":"no","effect":"You put the pink bar to its place.","final":false}],"deadline":40.0,"to":"anna"}');
INSERT INTO "events" VALUES(8,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','clip_recorded',4.0,1,'{"seq":8,"time":4.0,"wall_time":"2026-01-02T03:04:08Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"clip_recorded","robot":"robot","issue":"dropped","execution":"5d0f2c1e-0a44-4a0c-8a3e-9f6f3f2b1a01","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","pictures":[{"time":1.0,"picture":"3e2d1c0b-9a8f-4e7d-8c6b-5a4f3e2d1c04"}]}');
INSERT INTO "events" VALUES(9,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','claimed',4.5,1,'{"seq":9,"time":4.5,"wall_time":"2026-01-02T03:04:09Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"claimed","helper":"anna","lease_until":"2026-01-02T03:05:00Z"}');
INSERT INTO "events" VALUES(10,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','released',5.0,1,'{"seq":10,"time":5.0,"wall_time":"2026-01-02T03:04:10Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"released","helper":"anna","expired":true}');
INSERT INTO "events" VALUES(11,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','escalated',5.5,1,'{"seq":11,"time":5.5,"wall_time":"2026-01-02T03:04:11Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"escalated","channel":"mail","to":"operators@example.com"}');
INSERT INTO "events" VALUES(12,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','deadline_extended',6.0,1,'{"seq":12,"time":6.0,"wall_time":"2026-01-02T03:04:12Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"deadline_extended","prompt":"9a3b1c2d-1f2e-4d3c-8b4a-6e5f7a8b9c03","version":2,"deadline":80.0,"extensions_left":9,"helper":"ben"}');
INSERT INTO "events" VALUES(13,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','answered',6.5,1,'{"seq":13,"time":6.5,"wall_time":"2026-01-02T03:04:13Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"answered","prompt":"9a3b1c2d-1f2e-4d3c-8b4a-6e5f7a8b9c03","version":2,"answer":"yes","helper":"ben"}');
INSERT INTO "events" VALUES(14,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','help_awaited',7.0,1,'{"seq":14,"time":7.0,"wall_time":"2026-01-02T03:04:14Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"help_awaited","help":"put_back","helper":"ben","until":90.0}');
INSERT INTO "events" VALUES(15,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','help_not_seen',7.5,1,'{"seq":15,"time":7.5,"wall_time":"2026-01-02T03:04:15Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"help_not_seen","help":"put_back"}');
INSERT INTO "events" VALUES(16,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','intervention',8.0,1,'{"seq":16,"time":8.0,"wall_time":"2026-01-02T03:04:16Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"intervention","act":"put_back","object":"pink_bar","intervention":{"act":"put_back","object":"pink_bar","place":null,"to":null,"manner":"vanish"},"by":"helper","ok":true,"detail":"","command":null}');
INSERT INTO "events" VALUES(17,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','help_verified',8.5,1,'{"seq":17,"time":8.5,"wall_time":"2026-01-02T03:04:17Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"help_verified","help":"put_back"}');
INSERT INTO "events" VALUES(18,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','resolved',9.0,1,'{"seq":18,"time":9.0,"wall_time":"2026-01-02T03:04:18Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"resolved","resolution":"robot_retry","helped":true}');
INSERT INTO "events" VALUES(19,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','dialogue_closed',9.5,1,'{"seq":19,"time":9.5,"wall_time":"2026-01-02T03:04:19Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"dialogue_closed","reason":"resolved"}');
INSERT INTO "events" VALUES(20,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_reset',10.0,1,'{"seq":20,"time":10.0,"wall_time":"2026-01-02T03:04:20Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_reset","robot":"robot","reason":"robot_retry","failed_attempt":false}');
INSERT INTO "events" VALUES(21,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot_lost',10.5,1,'{"seq":21,"time":10.5,"wall_time":"2026-01-02T03:04:21Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"robot_lost","reason":"the process ended"}');
INSERT INTO "events" VALUES(22,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot_back',11.0,1,'{"seq":22,"time":11.0,"wall_time":"2026-01-02T03:04:22Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"robot_back","boot":"boot-2","continues":false}');
INSERT INTO "events" VALUES(23,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot_resumed',11.5,1,'{"seq":23,"time":11.5,"wall_time":"2026-01-02T03:04:23Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"robot_resumed","step":1}');
INSERT INTO "events" VALUES(24,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_done',12.0,1,'{"seq":24,"time":12.0,"wall_time":"2026-01-02T03:04:24Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_done","robot":"robot","by":"robot"}');
INSERT INTO "events" VALUES(25,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_undone',12.5,1,'{"seq":25,"time":12.5,"wall_time":"2026-01-02T03:04:25Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_undone","robot":"robot","reason":"the pink bar is gone","because_of":null}');
INSERT INTO "events" VALUES(26,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_left_out',13.0,1,'{"seq":26,"time":13.0,"wall_time":"2026-01-02T03:04:26Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_left_out","robot":"robot","helper":"ben"}');
INSERT INTO "events" VALUES(27,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_returned',13.5,1,'{"seq":27,"time":13.5,"wall_time":"2026-01-02T03:04:27Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_returned","robot":"robot"}');
INSERT INTO "events" VALUES(28,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_abandoned',14.0,1,'{"seq":28,"time":14.0,"wall_time":"2026-01-02T03:04:28Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_abandoned","leaf":"/1/0","reason":"no robot can reach it"}');
INSERT INTO "events" VALUES(29,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_paused',14.5,1,'{"seq":29,"time":14.5,"wall_time":"2026-01-02T03:04:29Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_paused"}');
INSERT INTO "events" VALUES(30,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_resumed',15.0,1,'{"seq":30,"time":15.0,"wall_time":"2026-01-02T03:04:30Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_resumed"}');
INSERT INTO "events" VALUES(31,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_finished',15.5,1,'{"seq":31,"time":15.5,"wall_time":"2026-01-02T03:04:31Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_finished","missing":[{"node":"/1/0","name":"pink_bar","object":"pink_bar","place":"pink_place","left_out_by":null}]}');
INSERT INTO "events" VALUES(32,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_failed',16.0,1,'{"seq":32,"time":16.0,"wall_time":"2026-01-02T03:04:32Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_failed","reason":"the leaf /1/0 could not be done","node":"/1/0"}');
INSERT INTO "events" VALUES(33,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_aborted',16.5,1,'{"seq":33,"time":16.5,"wall_time":"2026-01-02T03:04:33Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_aborted","reason":"by the operator"}');
INSERT INTO "events" VALUES(34,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','intervention_accepted',17.0,1,'{"seq":34,"time":17.0,"wall_time":"2026-01-02T03:04:34Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"intervention_accepted","act":"steal","object":"pink_bar","intervention":{"act":"steal","object":"pink_bar","place":null,"to":null,"manner":"vanish"},"by":"api","command":"7f6e5d4c-3b2a-4190-8f7e-6d5c4b3a2905"}');
CREATE TABLE pictures (id TEXT PRIMARY KEY, jpeg BLOB NOT NULL) STRICT;
INSERT INTO "pictures" VALUES('3e2d1c0b-9a8f-4e7d-8c6b-5a4f3e2d1c04',X'FFD8FFD9');
CREATE TABLE receipts (
    robot TEXT NOT NULL,
    boot TEXT NOT NULL,
    seq INTEGER NOT NULL,
    PRIMARY KEY (robot, boot)
) STRICT, WITHOUT ROWID;
INSERT INTO "receipts" VALUES('robot','boot-1',34);
CREATE TABLE schema_version (version INTEGER PRIMARY KEY, applied TEXT NOT NULL) STRICT;
INSERT INTO "schema_version" VALUES(1,'2026-11-22T14:17:29.492330+00:00');
INSERT INTO "schema_version" VALUES(2,'2026-11-22T14:17:29.505445+00:00');
CREATE TABLE worlds (run TEXT PRIMARY KEY, state TEXT NOT NULL) STRICT;
INSERT INTO "worlds" VALUES('0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','{"clock": 17.0}');
CREATE INDEX events_of_run ON events (run, seq);
CREATE INDEX run_starts ON events (seq, run) WHERE type = 'run_started';
COMMIT;
