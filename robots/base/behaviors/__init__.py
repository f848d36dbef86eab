"""What a base can do: behaviors as lists of drives, and the execution that drives them."""

from mend.robots.base.behaviors.behavior import BaseBehavior, BaseSituation, BaseStep, Drive

__all__ = ["BaseBehavior", "BaseSituation", "BaseStep", "Drive"]
