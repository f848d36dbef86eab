BEGIN TRANSACTION;
CREATE TABLE batches (
    last INTEGER PRIMARY KEY,
    first INTEGER NOT NULL,
    written BLOB,
    kept BLOB,
    link BLOB NOT NULL
) STRICT;
INSERT INTO "batches" VALUES(1,1,X'E38425E9568D6959A08E404CB5E53991',NULL,X'C42EA9EFE0CA3ED20D1CD9F4A1C9B72C');
INSERT INTO "batches" VALUES(2,2,X'AA7903A288C65C30973715AF7C4ED154',NULL,X'5220900609B03C679AA7A9F8BB6FB4C8');
INSERT INTO "batches" VALUES(3,3,X'712DE4438F2F9772B03EDD37B50AF954',NULL,X'47BF92913F557B31C507D7ADAB9FDF80');
INSERT INTO "batches" VALUES(4,4,X'23CE9945607761C8BD65DDD1E8CE8A98',NULL,X'CBBE2CA950A2BDABE1DB8A02CA12A5E9');
INSERT INTO "batches" VALUES(5,5,X'AAA3EF899FD91A24E3378E1E63AA703F',NULL,X'9DAB61B0523DC0457AED1D283248D4B2');
INSERT INTO "batches" VALUES(6,6,X'3CC7B3965057D183B5379CA5F103E718',NULL,X'9099E442A1001967F3BAE82E122F0FA0');
INSERT INTO "batches" VALUES(7,7,X'36C1C47DCF4ED2895560D80A8A27A4DE',NULL,X'DABC4CB28712978924A346EC0B188E93');
INSERT INTO "batches" VALUES(8,8,X'C22898E052D41A5991080D7801B51911',NULL,X'6F44707CBC50AE3CD36312C9C64F7B00');
INSERT INTO "batches" VALUES(9,9,X'06DFCBC740771AC9E5F468E9E53097CE',NULL,X'3C907DAD5F9EF78967887BC8B180564E');
INSERT INTO "batches" VALUES(10,10,X'448B30A933B5DA443E94D2ABD45BC622',NULL,X'AE7D27FB7253EFF94713912478F37CF2');
INSERT INTO "batches" VALUES(11,11,X'66CD2AC06DAA850D493050275616E01F',NULL,X'717B1F549517BD347EDAAC7D4511D724');
INSERT INTO "batches" VALUES(12,12,X'B66BA299192C0B12B020C6E5E80BEA3A',NULL,X'1BC2A61C6E30A18D89AB6D4AC951478A');
INSERT INTO "batches" VALUES(13,13,X'49ECB191F3CFDA9A00BDE7557393639B',NULL,X'3B49D78365F5C2B32E2432288B69761C');
INSERT INTO "batches" VALUES(14,14,X'B5EA2A74C03AA04DD6DBC12A9AB82DB3',NULL,X'D7549A77A2B0A5B321A703B0326D4504');
INSERT INTO "batches" VALUES(15,15,X'B90996039EBB3127338C384A0CC241CB',NULL,X'00FB7BDECD41734A38F2DF6F2B384B6F');
INSERT INTO "batches" VALUES(16,16,X'E3B84D9A5F0681385B51661BC7300D24',NULL,X'176B5F48234CF1E5E6FDCBCCC53ED17F');
INSERT INTO "batches" VALUES(17,17,X'A5448762E340B64BC56A26E573480C10',NULL,X'8BE399EEAB0D3165725B3648A615ED8B');
INSERT INTO "batches" VALUES(18,18,X'2D9293D9A2DFC59819E5379EBC4F4B5E',NULL,X'54410DF0F824A02A124CE270427A0565');
INSERT INTO "batches" VALUES(19,19,X'7554EBA0B2E4DE65D9DC671BFAEA20FF',NULL,X'59D6BB8C73BEEA084668F1E45D15FDAE');
INSERT INTO "batches" VALUES(20,20,X'271F22684F210F1D1B0AB3EDE52386A8',NULL,X'FF6E8A99E2BB1B35AE600D6BC152CDBF');
INSERT INTO "batches" VALUES(21,21,X'309126B906D6763D4BD1D49D621D8887',NULL,X'B16EA377AC785EF726ED03B4BC779C57');
INSERT INTO "batches" VALUES(22,22,X'D3BE7A5D6765564E2813D1C9543EAF98',NULL,X'3C8344EF2B78C594326410B6B0722339');
INSERT INTO "batches" VALUES(23,23,X'C3B97D6F1D9E5A5B89EEDB4D7D119D8D',NULL,X'B599854EF759D8D69BD0EF97DA77C627');
INSERT INTO "batches" VALUES(24,24,X'1E3893070E2A0B7C0CFB78237E07E725',NULL,X'2B1AE130454E31E67B2D92823AAEE0EE');
INSERT INTO "batches" VALUES(25,25,X'9DF8A042EEDFA56F60C67B0E8D57DAE7',NULL,X'D29D3C3425A988A259240E860B46D3B3');
INSERT INTO "batches" VALUES(26,26,X'A613FFD5616B1184B2F3F64407E16F7A',NULL,X'7DCA210E3EDDCA19B9BE03CC38BD9B73');
INSERT INTO "batches" VALUES(27,27,X'14D01731FE5986203DFEAFF450720912',NULL,X'E40E79F3AB56E2B9C954AF242D502481');
INSERT INTO "batches" VALUES(28,28,X'356432FED9F9AFF2B7B03DB747C6A398',NULL,X'46D2B9EA44806820BCEA00BF49775447');
INSERT INTO "batches" VALUES(29,29,X'BED143200AA6F7E227427E854CECB72D',NULL,X'679797327F0785499DDC9828C0418FF5');
INSERT INTO "batches" VALUES(30,30,X'76A757B65A81BAB0691B130479368A17',NULL,X'45111E6C96412EE8231CAAB789016C3F');
INSERT INTO "batches" VALUES(31,31,X'D17E9C01B87F95CCCF16A4430B4E5788',NULL,X'8C8DBE0F3DBDA48895042D01572A15CB');
INSERT INTO "batches" VALUES(32,32,X'FF886CB421694077CB2BCC3D1E91086A',NULL,X'A6E6E4C956EBD7678DE52C5EC88029DE');
INSERT INTO "batches" VALUES(33,33,X'98F81652F7CC6D31B8821DE7C1BD45D7',NULL,X'FAF65557E4DFFA3EBD9829B258038F92');
INSERT INTO "batches" VALUES(34,34,X'9E9839685C64E144ADB257745CCE0C62',NULL,X'4B35C22F1E6A314B189E9140328B16A0');
INSERT INTO "batches" VALUES(35,35,X'3128201301EDD818CD6D106603885661',NULL,X'79B707D2CA2544AD1BE22028656F7B44');
INSERT INTO "batches" VALUES(36,36,X'9C76D0FCEB1DD83E1A8F29200FB2CA37',NULL,X'DA9F311DE44A31B17DF0ABDEC75CED04');
INSERT INTO "batches" VALUES(37,37,X'0A0B9D65BBF09B828BC4FB56B55AF6C8',NULL,X'1511AEB5D525C787CA9F22C2E07B6397');
INSERT INTO "batches" VALUES(38,38,X'E2B093F0A075D9F47A5BD45DCFA56D2C',NULL,X'89F3B4A4CB88618EE820B2B41ECCA296');
INSERT INTO "batches" VALUES(39,39,X'F5986A64E171838ECB5E8E5F069745C5',NULL,X'4FB50B2A9B4630A8FC6160769B31F83C');
INSERT INTO "batches" VALUES(40,40,X'0E42547D427737812F3F5D378616CC7A',NULL,X'539A7CF45DCD40F9CB07B11172DF195C');
INSERT INTO "batches" VALUES(41,41,X'8E5B1D78338356187BEAFED3F28C5A14',NULL,X'90665299B584AB93E05A6039B4B0BB4D');
INSERT INTO "batches" VALUES(42,42,X'07C01182DD024CBBA3D23F6F05A97ACA',NULL,X'95FC185F92F4764161CC8EF3E2B9AD03');
CREATE TABLE dialogues (
    dialogue TEXT PRIMARY KEY,
    run TEXT NOT NULL,
    opened INTEGER NOT NULL,
    closed INTEGER
) STRICT;
INSERT INTO "dialogues" VALUES('c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02','0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11',6,24);
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
INSERT INTO "events" VALUES(2,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_started',1.0,1,'{"seq":2,"time":1.0,"wall_time":"2026-01-02T03:04:02Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_started","robot":"robot","boot":"boot-1","execution":"5d0f2c1e-0a44-4a0c-8a3e-9f6f3f2b1a01","attempt":1,"candidates":[{"node":"/1/0","name":"pink_bar","level":0.5,"potential":1.7,"attempts":0,"in_place":false}]}');
INSERT INTO "events" VALUES(3,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','step_started',1.5,1,'{"seq":3,"time":1.5,"wall_time":"2026-01-02T03:04:03Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"step_started","robot":"robot","execution":"5d0f2c1e-0a44-4a0c-8a3e-9f6f3f2b1a01","step":4,"step_name":"above pick","phase":null,"object":null}');
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
INSERT INTO "events" VALUES(16,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','help_reported',8.0,1,'{"seq":16,"time":8.0,"wall_time":"2026-01-02T03:04:16Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"help_reported","help":"put_back","helper":"anna","author":null}');
INSERT INTO "events" VALUES(17,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','help_not_seen_yet',8.5,1,'{"seq":17,"time":8.5,"wall_time":"2026-01-02T03:04:17Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","help":"put_back","felt":null,"blind":null,"picture":"3e2d1c0b-9a8f-4e7d-8c6b-5a4f3e2d1c04","detection":null,"type":"help_not_seen_yet","sight":"unmoved"}');
INSERT INTO "events" VALUES(18,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','looked_anew',9.0,1,'{"seq":18,"time":9.0,"wall_time":"2026-01-02T03:04:18Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"looked_anew","fulfilled":[],"position":null}');
INSERT INTO "events" VALUES(19,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','help_not_seen',9.5,1,'{"seq":19,"time":9.5,"wall_time":"2026-01-02T03:04:19Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","help":"put_back","felt":null,"blind":null,"picture":null,"detection":null,"type":"help_not_seen"}');
INSERT INTO "events" VALUES(20,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','promise_taken_back',10.0,1,'{"seq":20,"time":10.0,"wall_time":"2026-01-02T03:04:20Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"promise_taken_back","help":"put_back","helper":"ben","author":null}');
INSERT INTO "events" VALUES(21,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','intervention',10.5,1,'{"seq":21,"time":10.5,"wall_time":"2026-01-02T03:04:21Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"intervention","act":"put_back","object":"pink_bar","intervention":{"act":"put_back","object":"pink_bar","place":null,"to":null,"manner":"vanish","between":null,"elevator":null},"by":"helper","ok":true,"detail":"","command":null}');
INSERT INTO "events" VALUES(22,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','help_verified',11.0,1,'{"seq":22,"time":11.0,"wall_time":"2026-01-02T03:04:22Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"help_verified","help":"put_back","change":"unknown","at_place":false}');
INSERT INTO "events" VALUES(23,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','resolved',11.5,1,'{"seq":23,"time":11.5,"wall_time":"2026-01-02T03:04:23Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"resolved","resolution":"robot_retry","helped":true}');
INSERT INTO "events" VALUES(24,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','dialogue_closed',12.0,1,'{"seq":24,"time":12.0,"wall_time":"2026-01-02T03:04:24Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","dialogue":"c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02","robot":"robot","issue":"dropped","object":"pink_bar","type":"dialogue_closed","reason":"resolved"}');
INSERT INTO "events" VALUES(25,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_reset',12.5,1,'{"seq":25,"time":12.5,"wall_time":"2026-01-02T03:04:25Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_reset","robot":"robot","reason":"robot_retry","failed_attempt":false}');
INSERT INTO "events" VALUES(26,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot_lost',13.0,1,'{"seq":26,"time":13.0,"wall_time":"2026-01-02T03:04:26Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"robot_lost","reason":"the process ended"}');
INSERT INTO "events" VALUES(27,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot_back',13.5,1,'{"seq":27,"time":13.5,"wall_time":"2026-01-02T03:04:27Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"robot_back","boot":"boot-2","continues":false}');
INSERT INTO "events" VALUES(28,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot_resumed',14.0,1,'{"seq":28,"time":14.0,"wall_time":"2026-01-02T03:04:28Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"robot_resumed","step":1}');
INSERT INTO "events" VALUES(29,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_done',14.5,1,'{"seq":29,"time":14.5,"wall_time":"2026-01-02T03:04:29Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_done","robot":"robot","by":"robot"}');
INSERT INTO "events" VALUES(30,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_undone',15.0,1,'{"seq":30,"time":15.0,"wall_time":"2026-01-02T03:04:30Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_undone","robot":"robot","reason":"the pink bar is gone","because_of":null,"unseen":false}');
INSERT INTO "events" VALUES(31,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_left_out',15.5,1,'{"seq":31,"time":15.5,"wall_time":"2026-01-02T03:04:31Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_left_out","robot":"robot","helper":"ben"}');
INSERT INTO "events" VALUES(32,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_returned',16.0,1,'{"seq":32,"time":16.0,"wall_time":"2026-01-02T03:04:32Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_returned","robot":"robot"}');
INSERT INTO "events" VALUES(33,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_taken',16.5,1,'{"seq":33,"time":16.5,"wall_time":"2026-01-02T03:04:33Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_taken","helper":"ben","until":120.0,"was_at":[0.6,-0.2,0.7],"author":null}');
INSERT INTO "events" VALUES(34,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','way_found',17.0,1,'{"seq":34,"time":17.0,"wall_time":"2026-01-02T03:04:34Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","robot":"robot","type":"way_found","finding":"blocked","between":["F1-101","F1-102"]}');
INSERT INTO "events" VALUES(35,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','node_abandoned',17.5,1,'{"seq":35,"time":17.5,"wall_time":"2026-01-02T03:04:35Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"node_abandoned","leaf":"/1/0","reason":"no robot can reach it"}');
INSERT INTO "events" VALUES(36,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','suspected_false_alarm',18.0,1,'{"seq":36,"time":18.0,"wall_time":"2026-01-02T03:04:36Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","node":"/1/0","name":"pink_bar","type":"suspected_false_alarm","robot":"robot","issue":"dropped","object":"pink_bar","times":3,"explanation":"","told":["operators"]}');
INSERT INTO "events" VALUES(37,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_paused',18.5,1,'{"seq":37,"time":18.5,"wall_time":"2026-01-02T03:04:37Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_paused","author":null}');
INSERT INTO "events" VALUES(38,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_resumed',19.0,1,'{"seq":38,"time":19.0,"wall_time":"2026-01-02T03:04:38Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_resumed","author":null}');
INSERT INTO "events" VALUES(39,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_finished',19.5,1,'{"seq":39,"time":19.5,"wall_time":"2026-01-02T03:04:39Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_finished","missing":[{"node":"/1/0","name":"pink_bar","object":"pink_bar","place":"pink_place","left_out_by":null,"nowhere":false}],"unseen":[]}');
INSERT INTO "events" VALUES(40,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_failed',20.0,1,'{"seq":40,"time":20.0,"wall_time":"2026-01-02T03:04:40Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_failed","reason":"the leaf /1/0 could not be done","node":"/1/0"}');
INSERT INTO "events" VALUES(41,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','run_aborted',20.5,1,'{"seq":41,"time":20.5,"wall_time":"2026-01-02T03:04:41Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_aborted","reason":"by the operator","author":null}');
INSERT INTO "events" VALUES(42,'0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','intervention_accepted',21.0,1,'{"seq":42,"time":21.0,"wall_time":"2026-01-02T03:04:42Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"intervention_accepted","act":"steal","object":"pink_bar","intervention":{"act":"steal","object":"pink_bar","place":null,"to":null,"manner":"vanish","between":null,"elevator":null},"by":"api","command":"7f6e5d4c-3b2a-4190-8f7e-6d5c4b3a2905","author":null}');
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
CREATE TABLE picks (
    run TEXT NOT NULL,
    robot TEXT NOT NULL,
    part TEXT NOT NULL,
    picks INTEGER NOT NULL,
    PRIMARY KEY (run, robot, part)
) STRICT, WITHOUT ROWID;
CREATE TABLE pictures (id TEXT PRIMARY KEY, jpeg BLOB NOT NULL) STRICT;
INSERT INTO "pictures" VALUES('3e2d1c0b-9a8f-4e7d-8c6b-5a4f3e2d1c04',X'FFD8FFD9');
CREATE TABLE pruned (
    only INTEGER PRIMARY KEY CHECK (only = 1),
    through INTEGER NOT NULL,
    runs INTEGER NOT NULL
) STRICT;
INSERT INTO "pruned" VALUES(1,0,0);
CREATE TABLE pruning (run TEXT PRIMARY KEY) STRICT;
CREATE TABLE questions (
    prompt TEXT PRIMARY KEY,
    run TEXT NOT NULL,
    robot TEXT NOT NULL,
    issue TEXT NOT NULL,
    part TEXT NOT NULL,
    asked REAL NOT NULL,
    answer_s REAL
) STRICT, WITHOUT ROWID;
INSERT INTO "questions" VALUES('9a3b1c2d-1f2e-4d3c-8b4a-6e5f7a8b9c03','0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','robot','dropped','pink_bar',1767323047.0,NULL);
CREATE TABLE receipts (
    robot TEXT NOT NULL,
    boot TEXT NOT NULL,
    seq INTEGER NOT NULL, time REAL NOT NULL DEFAULT 0.0,
    PRIMARY KEY (robot, boot)
) STRICT, WITHOUT ROWID;
INSERT INTO "receipts" VALUES('robot','boot-1',42,1767323040.0);
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
INSERT INTO "runs" VALUES('0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11',1,41,'aborted',20.5,1767323041.0,1767323081.0,'eket','workcell','eket_paper',7,'max','["robot"]','{"seq":41,"time":20.5,"wall_time":"2026-01-02T03:04:41Z","run":"0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11","type":"run_aborted","reason":"by the operator","author":null}',NULL);
CREATE TABLE schema_version (version INTEGER PRIMARY KEY, applied TEXT NOT NULL) STRICT;
INSERT INTO "schema_version" VALUES(1,'2026-11-29T07:16:19.530302+00:00');
INSERT INTO "schema_version" VALUES(2,'2026-11-29T07:16:19.544119+00:00');
INSERT INTO "schema_version" VALUES(3,'2026-11-29T07:16:19.565940+00:00');
INSERT INTO "schema_version" VALUES(4,'2026-11-29T07:16:19.585952+00:00');
INSERT INTO "schema_version" VALUES(5,'2026-11-29T07:16:19.610283+00:00');
INSERT INTO "schema_version" VALUES(6,'2026-11-29T07:16:19.631542+00:00');
INSERT INTO "schema_version" VALUES(7,'2026-11-29T07:16:19.657899+00:00');
CREATE TABLE worlds (run TEXT PRIMARY KEY, state TEXT NOT NULL) STRICT;
INSERT INTO "worlds" VALUES('0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11','{"clock": 21.0}');
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
CREATE INDEX questions_of_run ON questions (run);
CREATE INDEX runs_by_start ON runs (started);
COMMIT;
