// A scene that is set in a small building, as the service has it: what is a default is left out.
export const OFFICE = {
  name: "office",
  objects: {},
  places: {
    "F1-101": { pose: { x: 1, y: 3, z: null, yaw: 0 } },
    "F2-204": { pose: { x: 2, y: 1, z: 3.5, yaw: 0 } },
    "F2-lift": { pose: { x: 5, y: 0, z: 3.5, yaw: 0 } },
  },
  robots: { robot1: { x: 1, y: 0, z: 0, yaw: 0 }, robot2: { x: 5, y: 0, z: 3.5, yaw: 0 } },
  setting: {
    building: "office",
    floors: {
      F2: {
        height: 3.5,
        places: { lift: { x: 5, y: 0, kind: "elevator" }, "204": { x: 2, y: 1, kind: "room" } },
      },
      F1: {
        places: {
          "101": { x: 1, y: 3, kind: "room" },
          hall: { x: 1, y: 0 },
          lift: { x: 5, y: 0, kind: "elevator" },
        },
        lanes: [{ between: ["101", "hall"] }, { between: ["hall", "lift"], one_way: true }],
        walls: [[0, 1.5, 0.5, 1.5], [1.5, 1.5, 6, 1.5], [0, -1, 6, -1]],
        doors: {
          "101": { posts: [[0.5, 1.5], [1.5, 1.5]] },
          auto: { posts: [[4, 1.5], [5, 1.5]], opens: "itself" },
        },
      },
    },
    elevators: { main: { stops: { F1: "lift", F2: "lift" } } },
  },
};
