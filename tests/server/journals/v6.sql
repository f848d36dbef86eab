BEGIN TRANSACTION;
CREATE TABLE batches (
    last INTEGER PRIMARY KEY,
    first INTEGER NOT NULL,
    written BLOB,
    kept BLOB,
    link BLOB NOT NULL
) STRICT;
INSERT INTO "batches" VALUES(1,1,X'E38425E9568D6959A08E404CB5E53991',NULL,X'C42EA9EFE0CA3ED20D1CD9F4A1C9B72C');
INSERT INTO "batches" VALUES(2,2,X'8E6D5127624A41DED14A2FA9916B9BA1',NULL,X'771B2965B7E8F9CD92BDE351AD149916');
INSERT INTO "batches" VALUES(3,3,X'FFDB072A610344E6E1799524A2016AB6',NULL,X'9F5121CD7CAF1249DBD5FA8A7E129B43');
INSERT INTO "batches" VALUES(4,4,X'23CE9945607761C8BD65DDD1E8CE8A98',NULL,X'6C2DA649561FDCDE939F121319766BCB');
INSERT INTO "batches" VALUES(5,5,X'AAA3EF899FD91A24E3378E1E63AA703F',NULL,X'4C90C24F64CEB4752AF2C866A97BC166');
INSERT INTO "batches" VALUES(6,6,X'3CC7B3965057D183B5379CA5F103E718',NULL,X'05BEC547FBCF6A0D5B110BE7CF34DB74');
INSERT INTO "batches" VALUES(7,7,X'36C1C47DCF4ED2895560D80A8A27A4DE',NULL,X'4BFC79E026245DF777187F85541EE7C6');
INSERT INTO "batches" VALUES(8,8,X'C22898E052D41A5991080D7801B51911',NULL,X'C26305ACF60A2AE1F43B453631C3EAC5');
INSERT INTO "batches" VALUES(9,9,X'06DFCBC740771AC9E5F468E9E53097CE',NULL,X'A83CB4EDC294CD7D3D46877EFBDA3BAD');
INSERT INTO "batches" VALUES(10,10,X'448B30A933B5DA443E94D2ABD45BC622',NULL,X'9080F77CE09C4B13D3029DBBDA53F0A6');
INSERT INTO "batches" VALUES(11,11,X'66CD2AC06DAA850D493050275616E01F',NULL,X'0359D3E017FAE8DAA915F8E9CBD14F27');
INSERT INTO "batches" VALUES(12,12,X'B66BA299192C0B12B020C6E5E80BEA3A',NULL,X'29F6ED6D6D8D18D7C170C493BCA02823');
INSERT INTO "batches" VALUES(13,13,X'49ECB191F3CFDA9A00BDE7557393639B',NULL,X'98C4140220E668E73B7A20AD9478254C');
INSERT INTO "batches" VALUES(14,14,X'B5EA2A74C03AA04DD6DBC12A9AB82DB3',NULL,X'636CA89404C72BFBD33F2613218BE70A');
INSERT INTO "batches" VALUES(15,15,X'B90996039EBB3127338C384A0CC241CB',NULL,X'BD3930954B452350A455825A65C2D810');
INSERT INTO "batches" VALUES(16,16,X'148DCA27DFC4B609C8483A1A6DE7D5B8',NULL,X'D038ABA5639B22713B0C9E247E5259B5');
INSERT INTO "batches" VALUES(17,17,X'135B1D5B3CFD12BBD9DC605840592300',NULL,X'4FD534A72507C67110474A60600CBDAF');
INSERT INTO "batches" VALUES(18,18,X'A9804BCA2A76FBBC5293C4561E31EC4C',NULL,X'13C1384A0C06BA6FD839B03D3A3D76E9');
INSERT INTO "batches" VALUES(19,19,X'8FF21EC1CE1DD66BA3A1054C7F5B5744',NULL,X'6DD0863D3A48A7E503A124CF9A645E7D');
INSERT INTO "batches" VALUES(20,20,X'5764EA4256FCAAC0F0F43BF34E7EC95C',NULL,X'B1B86D75ED76960FD2A7DCFA4C749A61');
INSERT INTO "batches" VALUES(21,21,X'A0C7EA65FBA66E9BDEBF962494310104',NULL,X'20300BEB038D76BADF5831B74511DDB4');
INSERT INTO "batches" VALUES(22,22,X'3A5B60AB1D99005F39602196AF3358AC',NULL,X'E514F44E6EB338A64A5A9977A822C62D');
INSERT INTO "batches" VALUES(23,23,X'436E26F4905CE9783DE7B3E0D12A61E1',NULL,X'56456145A7DFD2A852774F3B488BF4DB');
INSERT INTO "batches" VALUES(24,24,X'782A3B02191CFB31CE0B27DE980F4B30',NULL,X'FE95AC582ECF636B3211553CDAC50C99');
INSERT INTO "batches" VALUES(25,25,X'B1E95352E0902E6902377388B4CDEF53',NULL,X'E3C5CE72B8A26382A5D74A82A34AFA77');
INSERT INTO "batches" VALUES(26,26,X'5FCC890BED307FB749C36C13DD43F966',NULL,X'BBC6E9FC6DC48F994648D88BFA6B489B');
INSERT INTO "batches" VALUES(27,27,X'DD74A13B2C773656DCE5D56C107F8DD6',NULL,X'33FF1428D93D9607F9345429E8B71D4D');
INSERT INTO "batches" VALUES(28,28,X'D54F0738D493DF78236CFF8317E9D15E',NULL,X'3FF9B522F4049184217D11E2C1349752');
INSERT INTO "batches" VALUES(29,29,X'59BAD1EACA848881C18E90084E72007F',NULL,X'C8EC1C7941B126C1181AABF6114F36A4');
INSERT INTO "batches" VALUES(30,30,X'881C72F143F883769FD32BB4A36EFB85',NULL,X'2E5E9D1B8C105281034EBEC3D6089315');
INSERT INTO "batches" VALUES(31,31,X'AE12EF9C1504B61A2C36C30B6EFCA777',NULL,X'226D3F7F532ED06A652619F0C2A2AE43');
INSERT INTO "batches" VALUES(32,32,X'64B46720941B0D8A17C2802437E26FB8',NULL,X'147D905B3D20E739025A44F6AD560B53');
INSERT INTO "batches" VALUES(33,33,X'7AE1629D18D9D68F54DE41EC811E290E',NULL,X'771E4110C28A25DBBB3C8520E4EC95F4');
INSERT INTO "batches" VALUES(34,34,X'5E8558CBE48F1A6B307918556D481228',NULL,X'278A779D67EED86022BCC5C2AE43F174');
INSERT INTO "batches" VALUES(35,35,X'A7E65F50B9231C2523DC44F6D78F79AA',NULL,X'A77532D56CA09FF824F061695DA15197');
INSERT INTO "batches" VALUES(36,36,X'30130BCA40FAD686220197F881DBC1CF',NULL,X'FC85118ECF2E29DF2823D197A3A698BC');
CREATE TABLE dialogues (
    dialogue TEXT PRIMARY KEY,
    run TEXT NOT NULL,
    opened INTEGER NOT NULL,
    closed INTEGER
) STRICT;
INSERT INTO "dialogues" VALUES('c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02','0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11',6,20);
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
INSERT INTO "events" VALUES(1,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_started',0.5,1,'{"seq":1,"time":0.5,"wall_time":"2026-01-02T03:04:01Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_started","tree_name":"eket","tree":{"name":"eket","scene":"eket","then":[{"behavior":"pick_and_place","object":"pink_bar","place":"pink_place"}]},"scene":{"name":"eket","objects":{},"places":{}},"world":"workcell","robots":["robot"],"seed":7,"speed":"max","scenario":"eket_paper","script":{"name":"eket_paper","tree":"eket"},"options":{"max_attempts":3},"author":null,"site":null}');
INSERT INTO "events" VALUES(2,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_started',1.0,1,'{"seq":2,"time":1.0,"wall_time":"2026-01-02T03:04:02Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_started","robot":"robot","boot":"boot-1","execution":"5d0f2c1e-0a44-4a0c-8a3e-9f6f3f2b1a01","attempt":1,"candidates":[{"node":"/1/0","name":"pink_bar","level":0.5,"potential":1.7,"attempts":0}]}');
INSERT INTO "events" VALUES(3,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','step_started',1.5,1,'{"seq":3,"time":1.5,"wall_time":"2026-01-02T03:04:03Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"step_started","robot":"robot","execution":"5d0f2c1e-0a44-4a0c-8a3e-9f6f3f2b1a01","step":4,"step_name":"above pick","phase":null}');
INSERT INTO "events" VALUES(4,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','issue_raised',2.0,1,'{"seq":4,"time":2.0,"wall_time":"2026-01-02T03:04:04Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"issue_raised","robot":"robot","issue":"dropped","object":"pink_bar","place":"pink_place","execution":"5d0f2c1e-0a44-4a0c-8a3e-9f6f3f2b1a01","step":4,"interrupts":true,"detection":{"camera":"forearm","size_px":null,"center":null,"expected":[160.0,120.0],"tolerance_px":40.0,"area_px":0,"felt":false,"part":null,"probability":null,"explanation":"no blob is left","guesses":[],"between":[],"robot":null},"picture":"3e2d1c0b-9a8f-4e7d-8c6b-5a4f3e2d1c04","last_seen":null,"outlook":null,"item":null,"message":null,"person":null,"held_by":null,"away_m":null}');
INSERT INTO "events" VALUES(5,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot_holding',2.5,1,'{"seq":5,"time":2.5,"wall_time":"2026-01-02T03:04:05Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"robot_holding","at":"neutral"}');
INSERT INTO "events" VALUES(6,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','dialogue_opened',3.0,1,'{"seq":6,"time":3.0,"wall_time":"2026-01-02T03:04:06Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"dialogue_opened","scripted":false}');
INSERT INTO "events" VALUES(7,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','prompt',3.5,1,'{"seq":7,"time":3.5,"wall_time":"2026-01-02T03:04:07Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"prompt","prompt":"9a3b1c2d-1f2e-4d3c-8b4a-6e5f7a8b9c03","version":1,"kind":"ask","text":"I dropped the pink bar. Shall I try again?","answers":[{"value":"yes","effect":"The robot tries again.","final":false},{"value":"no","effect":"You put the pink bar to its place.","final":false}],"deadline":40.0,"timeout_effect":"","to":"anna"}');
INSERT INTO "events" VALUES(8,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','first_look',4.0,1,'{"seq":8,"time":4.0,"wall_time":"2026-01-02T03:04:08Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"first_look","fulfilled":[],"position":[0.6,-0.2,0.7],"blind":false}');
INSERT INTO "events" VALUES(9,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','clip_recorded',4.5,1,'{"seq":9,"time":4.5,"wall_time":"2026-01-02T03:04:09Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"clip_recorded","robot":"robot","issue":"dropped","execution":"5d0f2c1e-0a44-4a0c-8a3e-9f6f3f2b1a01","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","pictures":[{"time":1.0,"picture":"3e2d1c0b-9a8f-4e7d-8c6b-5a4f3e2d1c04"}]}');
INSERT INTO "events" VALUES(10,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','claimed',5.0,1,'{"seq":10,"time":5.0,"wall_time":"2026-01-02T03:04:10Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"claimed","helper":"anna","lease_until":"2026-01-02T03:05:00Z","author":null}');
INSERT INTO "events" VALUES(11,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','released',5.5,1,'{"seq":11,"time":5.5,"wall_time":"2026-01-02T03:04:11Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"released","helper":"anna","expired":true,"author":null}');
INSERT INTO "events" VALUES(12,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','escalated',6.0,1,'{"seq":12,"time":6.0,"wall_time":"2026-01-02T03:04:12Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"escalated","channel":"mail","to":"operators@example.com"}');
INSERT INTO "events" VALUES(13,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','deadline_extended',6.5,1,'{"seq":13,"time":6.5,"wall_time":"2026-01-02T03:04:13Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"deadline_extended","prompt":"9a3b1c2d-1f2e-4d3c-8b4a-6e5f7a8b9c03","version":2,"deadline":80.0,"extensions_left":9,"helper":"ben","author":null}');
INSERT INTO "events" VALUES(14,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','answered',7.0,1,'{"seq":14,"time":7.0,"wall_time":"2026-01-02T03:04:14Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"answered","prompt":"9a3b1c2d-1f2e-4d3c-8b4a-6e5f7a8b9c03","version":2,"answer":"yes","helper":"ben","author":null}');
INSERT INTO "events" VALUES(15,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','help_awaited',7.5,1,'{"seq":15,"time":7.5,"wall_time":"2026-01-02T03:04:15Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"help_awaited","help":"put_back","guess":null,"helper":"ben","until":90.0}');
INSERT INTO "events" VALUES(16,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','help_not_seen',8.0,1,'{"seq":16,"time":8.0,"wall_time":"2026-01-02T03:04:16Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"help_not_seen","help":"put_back","felt":null,"blind":null}');
INSERT INTO "events" VALUES(17,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','intervention',8.5,1,'{"seq":17,"time":8.5,"wall_time":"2026-01-02T03:04:17Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"intervention","act":"put_back","object":"pink_bar","intervention":{"act":"put_back","object":"pink_bar","place":null,"to":null,"manner":"vanish","between":null,"elevator":null},"by":"helper","ok":true,"detail":"","command":null}');
INSERT INTO "events" VALUES(18,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','help_verified',9.0,1,'{"seq":18,"time":9.0,"wall_time":"2026-01-02T03:04:18Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"help_verified","help":"put_back","change":"unknown","at_place":false}');
INSERT INTO "events" VALUES(19,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','resolved',9.5,1,'{"seq":19,"time":9.5,"wall_time":"2026-01-02T03:04:19Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"resolved","resolution":"robot_retry","helped":true}');
INSERT INTO "events" VALUES(20,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','dialogue_closed',10.0,1,'{"seq":20,"time":10.0,"wall_time":"2026-01-02T03:04:20Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"dialogue_closed","reason":"resolved"}');
INSERT INTO "events" VALUES(21,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_reset',10.5,1,'{"seq":21,"time":10.5,"wall_time":"2026-01-02T03:04:21Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_reset","robot":"robot","reason":"robot_retry","failed_attempt":false}');
INSERT INTO "events" VALUES(22,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot_lost',11.0,1,'{"seq":22,"time":11.0,"wall_time":"2026-01-02T03:04:22Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"robot_lost","reason":"the process ended"}');
INSERT INTO "events" VALUES(23,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot_back',11.5,1,'{"seq":23,"time":11.5,"wall_time":"2026-01-02T03:04:23Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"robot_back","boot":"boot-2","continues":false}');
INSERT INTO "events" VALUES(24,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot_resumed',12.0,1,'{"seq":24,"time":12.0,"wall_time":"2026-01-02T03:04:24Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"robot_resumed","step":1}');
INSERT INTO "events" VALUES(25,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_done',12.5,1,'{"seq":25,"time":12.5,"wall_time":"2026-01-02T03:04:25Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_done","robot":"robot","by":"robot"}');
INSERT INTO "events" VALUES(26,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_undone',13.0,1,'{"seq":26,"time":13.0,"wall_time":"2026-01-02T03:04:26Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_undone","robot":"robot","reason":"the pink bar is gone","because_of":null,"unseen":false}');
INSERT INTO "events" VALUES(27,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_left_out',13.5,1,'{"seq":27,"time":13.5,"wall_time":"2026-01-02T03:04:27Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_left_out","robot":"robot","helper":"ben"}');
INSERT INTO "events" VALUES(28,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_returned',14.0,1,'{"seq":28,"time":14.0,"wall_time":"2026-01-02T03:04:28Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_returned","robot":"robot"}');
INSERT INTO "events" VALUES(29,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_abandoned',14.5,1,'{"seq":29,"time":14.5,"wall_time":"2026-01-02T03:04:29Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_abandoned","leaf":"/1/0","reason":"no robot can reach it"}');
INSERT INTO "events" VALUES(30,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','suspected_false_alarm',15.0,1,'{"seq":30,"time":15.0,"wall_time":"2026-01-02T03:04:30Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"suspected_false_alarm","robot":"robot","issue":"dropped","object":"pink_bar","times":3,"explanation":"","told":["operators"]}');
INSERT INTO "events" VALUES(31,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_paused',15.5,1,'{"seq":31,"time":15.5,"wall_time":"2026-01-02T03:04:31Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_paused","author":null}');
INSERT INTO "events" VALUES(32,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_resumed',16.0,1,'{"seq":32,"time":16.0,"wall_time":"2026-01-02T03:04:32Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_resumed","author":null}');
INSERT INTO "events" VALUES(33,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_finished',16.5,1,'{"seq":33,"time":16.5,"wall_time":"2026-01-02T03:04:33Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_finished","missing":[{"node":"/1/0","name":"pink_bar","object":"pink_bar","place":"pink_place","left_out_by":null,"nowhere":false}],"unseen":[]}');
INSERT INTO "events" VALUES(34,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_failed',17.0,1,'{"seq":34,"time":17.0,"wall_time":"2026-01-02T03:04:34Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_failed","reason":"the leaf /1/0 could not be done","node":"/1/0"}');
INSERT INTO "events" VALUES(35,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_aborted',17.5,1,'{"seq":35,"time":17.5,"wall_time":"2026-01-02T03:04:35Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_aborted","reason":"by the operator","author":null}');
INSERT INTO "events" VALUES(36,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','intervention_accepted',18.0,1,'{"seq":36,"time":18.0,"wall_time":"2026-01-02T03:04:36Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"intervention_accepted","act":"steal","object":"pink_bar","intervention":{"act":"steal","object":"pink_bar","place":null,"to":null,"manner":"vanish","between":null,"elevator":null},"by":"api","command":"7f6e5d4c-3b2a-4190-8f7e-6d5c4b3a2905","author":null}');
CREATE TABLE issues (
    seq INTEGER PRIMARY KEY,
    run TEXT NOT NULL,
    issue TEXT NOT NULL,
    object TEXT,
    place TEXT,
    robot TEXT NOT NULL,
    name TEXT NOT NULL,
    node TEXT NOT NULL,
    step INTEGER NOT NULL,
    time REAL NOT NULL,
    raised REAL NOT NULL,
    picture TEXT,
    dialogue TEXT,
    outcome TEXT
) STRICT;
INSERT INTO "issues" VALUES(4,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','dropped','pink_bar','pink_place','robot','pink_bar','/1/0',4,2.0,1767323044.0,'3e2d1c0b-9a8f-4e7d-8c6b-5a4f3e2d1c04','c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02','resolved');
CREATE TABLE pictures (id TEXT PRIMARY KEY, jpeg BLOB NOT NULL) STRICT;
INSERT INTO "pictures" VALUES('3e2d1c0b-9a8f-4e7d-8c6b-5a4f3e2d1c04',X'FFD8FFD9');
CREATE TABLE pruned (
    only INTEGER PRIMARY KEY CHECK (only = 1),
    through INTEGER NOT NULL,
    runs INTEGER NOT NULL
) STRICT;
INSERT INTO "pruned" VALUES(1,0,0);
CREATE TABLE pruning (run TEXT PRIMARY KEY) STRICT;
CREATE TABLE receipts (
    robot TEXT NOT NULL,
    boot TEXT NOT NULL,
    seq INTEGER NOT NULL, time REAL NOT NULL DEFAULT 0.0,
    PRIMARY KEY (robot, boot)
) STRICT, WITHOUT ROWID;
INSERT INTO "receipts" VALUES('robot','boot-1',36,1767323040.0);
CREATE TABLE requests (
    principal TEXT NOT NULL,
    key TEXT NOT NULL,
    digest BLOB NOT NULL,
    seq INTEGER NOT NULL,
    run TEXT NOT NULL,
    time REAL NOT NULL,
    status INTEGER,
    headers TEXT,
    body BLOB,
    PRIMARY KEY (principal, key)
) STRICT;
CREATE TABLE runs (
    run TEXT PRIMARY KEY,
    begun INTEGER NOT NULL,
    ended INTEGER,
    status TEXT NOT NULL,
    time REAL NOT NULL,
    started REAL NOT NULL,
    ended_at REAL,
    tree TEXT NOT NULL,
    world TEXT NOT NULL,
    scenario TEXT,
    seed INTEGER NOT NULL,
    speed TEXT NOT NULL,
    robots TEXT NOT NULL,
    ending TEXT,
    why TEXT
) STRICT;
INSERT INTO "runs" VALUES('0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11',1,35,'aborted',17.5,1767323041.0,1767323075.0,'eket','workcell','eket_paper',7,'max','["robot"]','{"seq":35,"time":17.5,"wall_time":"2026-01-02T03:04:35Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_aborted","reason":"by the operator","author":null}',NULL);
CREATE TABLE schema_version (version INTEGER PRIMARY KEY, applied TEXT NOT NULL) STRICT;
INSERT INTO "schema_version" VALUES(1,'2026-11-28T22:50:51.928239+00:00');
INSERT INTO "schema_version" VALUES(2,'2026-11-28T22:50:51.934958+00:00');
INSERT INTO "schema_version" VALUES(3,'2026-11-28T22:50:51.939906+00:00');
INSERT INTO "schema_version" VALUES(4,'2026-11-28T22:50:51.945344+00:00');
INSERT INTO "schema_version" VALUES(5,'2026-11-28T22:50:51.946163+00:00');
INSERT INTO "schema_version" VALUES(6,'2026-11-28T22:50:51.948224+00:00');
CREATE TABLE worlds (run TEXT PRIMARY KEY, state TEXT NOT NULL) STRICT;
INSERT INTO "worlds" VALUES('0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','{"clock": 18.0}');
CREATE INDEX events_of_run ON events (run, seq);
CREATE INDEX run_starts ON events (seq, run) WHERE type = 'run_started';
CREATE INDEX runs_in_order ON runs (begun);
CREATE INDEX runs_by_status ON runs (status, begun);
CREATE INDEX runs_by_end ON runs (ended, begun);
CREATE INDEX dialogues_in_order ON dialogues (opened);
CREATE INDEX dialogues_of_run ON dialogues (run);
CREATE INDEX requests_in_order ON requests (time);
CREATE INDEX requests_of_run ON requests (run);
CREATE INDEX issues_of_run ON issues (run, seq);
CREATE INDEX issues_of_kind ON issues (issue, seq);
CREATE INDEX issues_of_object ON issues (object, seq);
COMMIT;
