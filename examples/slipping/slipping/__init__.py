"""One more fault for Mend: an object that slips in the gripper. Built by addition only."""
