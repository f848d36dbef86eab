// Which robots say that they look like which model.
import type { ModelView, RobotView } from "../wire/types";

/** The names of the robots that say they look like a model. */
export function usersOf(model: string, robots: readonly RobotView[]): string[] {
  return robots.filter((robot) => robot.model === model).map((robot) => robot.robot);
}

/** The models that robots name and nobody has given, in the order of their names. */
export function missingModels(models: readonly ModelView[], robots: readonly RobotView[]): string[] {
  const there = new Set(models.map((model) => model.name));
  const named = robots.flatMap(({ model }) => (model === null || there.has(model) ? [] : [model]));
  return [...new Set(named)].sort();
}
